// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/model_order.h"

#include "codec/mesh/unit.h"
#include "server/metadata/text.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kMembers[] = {"upload", "metadata",  "publish", "replace", "webhook",
                                         "bits",   "placement", "unit",    "up",      "repairs"};
constexpr std::string_view kAxes[] = {"y", "z"};

template <class Id>
std::optional<Id> read_id(Fields& fields, const Json& body, const char* name,
                          const char* expected) {
  const auto found = body.find(name);
  if (found == body.end() || found->is_null()) return std::nullopt;
  const auto* text = found->get_ptr<const std::string*>();
  const auto id = text == nullptr ? std::nullopt : Id::parse(*text);
  if (!id) fields.fault(name, expected);
  return id;
}

void read_unit(Fields& fields, const Json& body, std::string& unit) {
  if (!body.contains("unit")) return;
  std::array<std::string_view, kLengthUnits.size()> names;
  std::ranges::transform(kLengthUnits, names.begin(), &LengthUnit::name);
  std::size_t choice = 0;
  fields.choice("unit", names, choice);
  unit = names[choice];
}

}  // namespace

tl::expected<ModelOrder, FieldFaults> parse_model_order(const Json& body) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ModelOrder order;
  fields.only(kMembers);
  constexpr const char* kUpload = "the id of an upload: what follows /api/v1/uploads/";
  const auto upload = read_id<UploadId>(fields, body, "upload", kUpload);
  if (!body.contains("upload")) fields.fault("upload", kUpload);
  order.upload = upload.value_or(UploadId());
  read_metadata(fields, body, order.metadata, faults);
  fields.flag("publish", order.is_public);
  order.replace = read_id<ModelId>(fields, body, "replace", "the id of a model");
  fields.text("webhook", order.webhook);
  read_bits(fields, body, order.bits);
  fields.choice("placement", kPlacementNames, order.placement);
  read_unit(fields, body, order.unit);
  int axis = 0;
  fields.choice("up", kAxes, axis);
  order.z_is_up = axis == 1;
  fields.lines("repairs", order.repairs);
  return order_or_faults(std::move(order), std::move(faults));
}

std::string to_json_text(const ModelOrder& order) {
  Json json = {{"upload", order.upload.to_string()},
               {"metadata", to_json(order.metadata)},
               {"publish", order.is_public},
               {"bits", order.bits},
               {"placement", kPlacementNames[static_cast<std::size_t>(order.placement)]},
               {"up", kAxes[order.z_is_up ? 1 : 0]}};
  if (order.replace) json["replace"] = order.replace->to_string();
  if (!order.webhook.empty()) json["webhook"] = order.webhook;
  if (!order.unit.empty()) json["unit"] = order.unit;
  if (!order.repairs.empty()) json["repairs"] = lines_of(order.repairs);
  return json.dump();
}

}  // namespace vitrine::server
