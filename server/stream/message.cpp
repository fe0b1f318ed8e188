// SPDX-License-Identifier: Apache-2.0
#include "server/stream/message.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace vitrine::server {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kMaxDepth = 4;
constexpr const char* kOneOf = "want: give one of triangles, bytes, level, error, seconds, view";

Unexpected malformed(const char* why) {
  return fail(ErrorCode::kBadInput, why);
}

std::optional<std::uint64_t> whole(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  return value.get<std::uint64_t>();
}

bool read_number(const Json& json, const char* name, double& out) {
  const auto member = json.find(name);
  if (member == json.end() || !member->is_number()) return false;
  out = member->get<double>();
  return true;
}

// Returns the number of the model in a message. Returns 0 if the message states no model, and
// nullopt if the number is invalid.
std::optional<std::uint16_t> model_of(const Json& json) {
  const auto member = json.find("model");
  if (member == json.end()) return std::uint16_t{0};
  const auto number = whole(*member);
  if (!number || *number >= kMaxModels) return std::nullopt;
  return static_cast<std::uint16_t>(*number);
}

Expected<DetailTarget> read_view(const Json& json) {
  const auto fault = malformed("want: view has camera (16 numbers), fov, width, height, pixels");
  View view;
  if (!json.is_object()) return fault;
  const auto camera = json.find("camera");
  if (camera == json.end() || !camera->is_array() || camera->size() != view.camera.size()) {
    return fault;
  }
  for (std::size_t i = 0; i < view.camera.size(); ++i) {
    if (!(*camera)[i].is_number()) return fault;
    view.camera[i] = (*camera)[i].get<double>();
  }
  const bool complete =
      read_number(json, "fov", view.field_of_view) && read_number(json, "width", view.width) &&
      read_number(json, "height", view.height) && read_number(json, "pixels", view.pixel_error);
  if (!complete || (json.contains("bytes") && !read_number(json, "bytes", view.bytes))) {
    return fault;
  }
  return is_sane(view) ? Expected<DetailTarget>(Want(view)) : fault;
}

Expected<DetailTarget> read_error(const Json& value) {
  if (!value.is_number() || !(value.get<double>() >= 0)) {
    return malformed("want: error is a number, 0 or more");
  }
  return DetailTarget(Want(WantError{value.get<double>()}));
}

Expected<DetailTarget> read_seconds(const Json& value) {
  const double seconds = value.is_number() ? value.get<double>() : 0;
  if (!(seconds > 0 && seconds <= kMaxSeconds)) {
    return malformed("want: seconds is a number above 0, at most 3600");
  }
  return DetailTarget(WantSeconds{seconds});
}

template <class Wanted, class Count = std::uint64_t>
Expected<DetailTarget> read_count(const Json& value) {
  const auto count = whole(value);
  if (!count) return malformed("want: triangles, bytes and level are whole numbers, 0 or more");
  return DetailTarget(Want(Wanted{
      static_cast<Count>(std::min<std::uint64_t>(*count, std::numeric_limits<Count>::max()))}));
}

struct TargetReader {
  const char* name;
  Expected<DetailTarget> (*read)(const Json& value);
};
constexpr TargetReader kTargets[] = {{"triangles", read_count<WantTriangles>},
                                     {"bytes", read_count<WantBytes>},
                                     {"level", read_count<WantLevel, std::uint32_t>},
                                     {"error", read_error},
                                     {"seconds", read_seconds},
                                     {"view", read_view}};

Expected<ClientMessage> parse_want(const Json& json, std::uint16_t model) {
  const TargetReader* found = nullptr;
  for (const TargetReader& reader : kTargets) {
    if (!json.contains(reader.name)) continue;
    if (found != nullptr) return malformed(kOneOf);
    found = &reader;
  }
  if (found == nullptr) return malformed(kOneOf);
  auto target = found->read(json[found->name]);
  if (!target) return tl::unexpected(target.error());
  const auto turn = json.contains("turn") ? whole(json["turn"]) : 0;
  if (!turn || *turn > std::numeric_limits<std::uint32_t>::max()) {
    return malformed("want: turn is a whole number below 2^32");
  }
  return WantMessage{model, static_cast<std::uint32_t>(*turn), *target};
}

Expected<ClientMessage> parse_have(const Json& json, std::uint16_t model) {
  const auto chunks = json.find("chunks");
  if (chunks == json.end() || !chunks->is_array() || chunks->size() > kMaxHaveRanges) {
    return malformed("have: chunks is a list of at most 4096 ranges");
  }
  HaveMessage have{.model = model, .chunks = {}};
  for (const Json& range : *chunks) {
    if (!range.is_array() || range.size() != 2) return malformed("have: a range is [first, last]");
    const auto first = whole(range[0]);
    const auto last = whole(range[1]);
    if (!first || !last || *last < *first) return malformed("have: a range is [first, last]");
    if (!have.chunks.empty() && *first <= have.chunks.back().last) {
      return malformed("have: the ranges ascend");
    }
    have.chunks.push_back({*first, *last});
  }
  return have;
}

Expected<ClientMessage> parse_ack(const Json& json) {
  const auto bytes = json.find("bytes");
  const auto count = bytes == json.end() ? std::nullopt : whole(*bytes);
  if (!count || *count < 1 || *count > kMaxAck) {
    return malformed("ack: bytes is a whole number from 1 to 16777216");
  }
  return AckMessage{*count};
}

Expected<ClientMessage> parse_open(const Json& json, std::uint16_t model) {
  const auto id = json.find("id");
  if (id == json.end() || !id->is_string() ||
      id->get_ref<const std::string&>().size() > kMaxIdText) {
    return malformed("open: id is a model's id");
  }
  const auto head = json.find("head");
  if (head != json.end() && !head->is_boolean()) return malformed("open: head is true or false");
  return OpenMessage{model, id->get<std::string>(), head != json.end() && head->get<bool>()};
}

OrderedJson target_json(const WantTriangles& want) {
  return {{"triangles", want.triangles}};
}
OrderedJson target_json(const WantBytes& want) {
  return {{"bytes", want.bytes}};
}
OrderedJson target_json(const WantError& want) {
  return {{"error", want.error}};
}
OrderedJson target_json(const WantLevel& want) {
  return {{"level", want.level}};
}
OrderedJson target_json(const WantSeconds& want) {
  return {{"seconds", want.seconds}};
}
OrderedJson target_json(const View& view) {
  OrderedJson json{{"camera", view.camera},
                   {"fov", view.field_of_view},
                   {"width", view.width},
                   {"height", view.height},
                   {"pixels", view.pixel_error}};
  if (std::isfinite(view.bytes)) json["bytes"] = view.bytes;
  return {{"view", std::move(json)}};
}
OrderedJson target_json(const Want& want) {
  return std::visit([](const auto& one) { return target_json(one); }, want);
}

OrderedJson about(const char* type, std::uint16_t model) {
  return {{"type", type}, {"model", model}};
}

OrderedJson json_of(const OpenMessage& message) {
  OrderedJson json = about("open", message.model);
  json["id"] = message.id;
  json["head"] = message.wants_head;
  return json;
}
OrderedJson json_of(const CloseMessage& message) {
  return about("close", message.model);
}
OrderedJson json_of(const WantMessage& message) {
  OrderedJson json = about("want", message.model);
  json["turn"] = message.turn;
  json.update(std::visit([](const auto& target) { return target_json(target); }, message.target));
  return json;
}
OrderedJson json_of(const HaveMessage& message) {
  OrderedJson json = about("have", message.model);
  OrderedJson& ranges = json["chunks"] = OrderedJson::array();
  for (const ChunkRange& range : message.chunks)
    ranges.push_back({range.first, range.last});
  return json;
}
OrderedJson json_of(const PauseMessage& message) {
  return about(message.is_pause ? "pause" : "resume", message.model);
}
OrderedJson json_of(const AckMessage& message) {
  return {{"type", "ack"}, {"bytes", message.bytes}};
}

}  // namespace

Expected<ClientMessage> parse_message(std::string_view text) {
  // Drops values that are nested too deeply while it parses the text, so that nesting cannot
  // exhaust the stack.
  const auto shallow = [](int depth, Json::parse_event_t, Json&) { return depth < kMaxDepth; };
  const Json json = Json::parse(text, shallow, /*allow_exceptions=*/false);
  if (!json.is_object()) return malformed("a message is a JSON object");
  const auto type = json.find("type");
  if (type == json.end() || !type->is_string()) return malformed("a message has a type");
  if (*type == "ack") return parse_ack(json);
  const auto model = model_of(json);
  if (!model) return malformed("model is a whole number from 0 to 15");
  if (*type == "want") return parse_want(json, *model);
  if (*type == "have") return parse_have(json, *model);
  if (*type == "pause" || *type == "resume") return PauseMessage{*model, *type == "pause"};
  if (*type == "open") return parse_open(json, *model);
  if (*type == "close") return CloseMessage{*model};
  return malformed("the type is want, have, ack, pause, resume, open or close");
}

std::vector<HaveMessage> have_messages(std::uint16_t model, std::span<const ChunkRange> chunks) {
  // A range takes at most 32 bytes of JSON: two numbers below 2^32 and punctuation.
  constexpr std::size_t kMost = kMaxMessage / 32;
  static_assert(kMost <= kMaxHaveRanges);
  std::vector<HaveMessage> messages;
  while (!chunks.empty()) {
    const auto some = chunks.first(std::min(kMost, chunks.size()));
    messages.push_back({model, {some.begin(), some.end()}});
    chunks = chunks.subspan(some.size());
  }
  return messages;
}

std::string to_json(const ClientMessage& message) {
  return std::visit([](const auto& one) { return json_of(one); }, message).dump();
}

}  // namespace vitrine::server
