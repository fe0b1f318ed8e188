// SPDX-License-Identifier: Apache-2.0
// Models are made of uploads, changed and taken away.
#include <nlohmann/json.hpp>

#include "codec/mesh/unit.h"
#include "server/http/conditional.h"
#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/model_json.h"
#include "server/http/published.h"
#include "server/jobs/publish_jobs.h"
#include "server/store/change.h"

namespace vitrine {
namespace {

constexpr double kMostAccuracy = 1e6;  // of the model's unit

// What is wrong with the order as things stand; the upload's token is the caller's.
FieldFaults check(const ModelOrder& order, const Request& request, Services& services) {
  FieldFaults faults = check_webhook(order.webhook, services);
  const auto upload = services.uploads.find(order.upload);
  const bool is_own =
      upload && (upload->token == request.caller->token || request.caller->role >= Role::kAdmin);
  if (!is_own) {
    faults.push_back({"upload", "the id of an upload of this token; there is none of that id"});
  } else if (!upload->is_whole()) {
    faults.push_back({"upload", fmt::format("an upload that is whole; {} of {} bytes have come",
                                            upload->offset, upload->length)});
  }
  if (!order.replace) return faults;
  const auto model = services.catalogue.find(*order.replace);
  if (!model || !*model) faults.push_back({"replace", "the id of a model that is there"});
  return faults;
}

Response accepted(const JobRecord& job) {
  Response response = json_answer({{"job", job.id.to_string()}}, 202);
  response.fields = {{"Location", "/api/v1/jobs/" + job.id.to_string()}};
  return response;
}

// Of both views: who reads without a token and changes with one is right, too.
bool matches(std::string_view list, const ModelRecord& model) {
  return matches_any(list, model_tag(model)) || matches_any(list, model_tag(public_view(model)));
}

Response model_has_changed(const Request& request) {
  return problem(412, "the model has changed since; read it again", request.id);
}

// 412 where the request is about another state of the model.
std::optional<Response> refuse_state(const ModelRecord& model, const Request& request) {
  const auto wanted = request.header.find(beast::http::field::if_match);
  if (wanted == request.header.end()) return std::nullopt;
  const auto list = wanted->value();
  if (matches({list.data(), list.size()}, model)) return std::nullopt;
  return model_has_changed(request);
}

// Of a change or removal of the model that was read as `before`. Where the request states which
// state it is about and somebody was faster, that state is gone: 412, as if they had been earlier.
Response refused_change(const Error& error, const ModelRecord& before, const Request& request,
                        Services& services) {
  const auto now = services.catalogue.find(before.id);
  const bool is_same = now && *now && (*now)->version == before.version;
  if (now && !is_same && request.header.count(beast::http::field::if_match) > 0)
    return model_has_changed(request);
  return refused(error, request, services);
}

// Calls `answer(record)` for the request's model, drafts too, or answers 404, 412 or 500.
template <class Answer>
Response with_record(const Request& request, Services& services, Answer&& answer) {
  const auto model = services.catalogue.find(request.parameters.id);
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  if (auto refused = refuse_state(**model, request)) return *refused;
  return answer(**model);
}

void read_unit(Fields& fields, const nlohmann::json& body, std::string& unit) {
  const auto found = body.find("unit");
  if (found == body.end()) return;
  const auto* given = found->get_ptr<const std::string*>();
  if (given == nullptr || !(given->empty() || metres_per(*given)))
    return fields.fault("unit", "mm, cm, m, in, or empty where it is unknown");
  unit = *given;
}

void read_accuracy(Fields& fields, const nlohmann::json& body, std::optional<double>& accuracy) {
  const auto found = body.find("accuracy");
  if (found != body.end() && found->is_null()) accuracy.reset();
  fields.real("accuracy", 0, kMostAccuracy, accuracy);
}

// null: all of it. A level beyond the finest is the finest of today.
void read_public_level(Fields& fields, const nlohmann::json& body,
                       std::optional<PublicPart>& part) {
  constexpr int kMostLevels = 255;
  const auto found = body.find("public_max_level");
  if (found == body.end()) return;
  if (found->is_null()) return part.reset();
  int level = 0;
  fields.whole("public_max_level", 0, kMostLevels, level);
  part = PublicPart{.max_level = static_cast<std::uint32_t>(level)};
}

// The texts may stand in the body itself, as GET shows them, or in its "metadata", as POST takes
// them.
tl::expected<ModelRecord, FieldFaults> changed(const ModelRecord& before,
                                               const nlohmann::json& body) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ModelRecord model = before;
  std::vector<std::string_view> known = metadata_names();
  known.insert(known.end(), {"metadata", "unit", "accuracy", "public_max_level"});
  fields.only(known);
  ModelMetadata texts{model.title, model.creator, model.rights, model.licence, model.more};
  read_texts(fields, texts);
  read_metadata(fields, body, texts, faults);
  model.title = texts.title;
  model.creator = texts.creator;
  model.rights = texts.rights;
  model.licence = texts.licence;
  model.more = texts.more;
  read_unit(fields, body, model.unit);
  read_accuracy(fields, body, model.accuracy);
  read_public_level(fields, body, model.public_part);
  return order_or_faults(std::move(model), std::move(faults));
}

}  // namespace

Response make_model(const Request& request, Services& services) {
  const auto order = parse_model_order(request.body);
  if (!order) return invalid(order.error(), request);
  const auto once = once_key(request);
  if (!once) return once.error();
  auto& jobs = services.scans.jobs();
  const auto begun = jobs.begun_by(*once);
  if (!begun) return refused_job(begun.error(), request, services);
  if (*begun) return accepted(**begun);  // its upload may be gone by now
  const auto held = services.uploads.hold();
  if (const auto faults = check(*order, request, services); !faults.empty())
    return invalid(faults, request);
  const auto job = jobs.add(PublishJobs::job_for(*order), std::nullopt, *once);
  return job ? accepted(*job) : refused_job(job.error(), request, services);
}

Response change_model(const Request& request, Services& services) {
  return with_record(request, services, [&](const ModelRecord& before) {
    const auto wanted = changed(before, request.body);
    if (!wanted) return invalid(wanted.error(), request);
    const auto model = change(services.store, services.catalogue, *wanted, &services.quota);
    if (!model) return refused_change(model.error(), before, request, services);
    services.models.refresh();
    services.collector.hurry();
    Response response;
    response.type = "application/json";
    response.body = model_json(*model);
    response.etag = model_tag(*model);
    return response;
  });
}

Response remove_model(const Request& request, Services& services) {
  return with_record(request, services, [&](const ModelRecord& model) {
    const bool conditional = request.header.count(beast::http::field::if_match) > 0;
    const auto removed = remove(services.store, services.catalogue, model.id,
                                conditional ? std::optional(model.version) : std::nullopt);
    if (!removed) return refused_change(removed.error(), model, request, services);
    services.models.refresh();
    services.collector.hurry();
    Response response;
    response.status = 204;
    return response;
  });
}

}  // namespace vitrine
