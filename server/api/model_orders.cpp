// SPDX-License-Identifier: Apache-2.0
// Defines the handlers that create models from uploads, change models and delete them.
#include <nlohmann/json.hpp>

#include "codec/mesh/unit.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/model_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/jobs/publish_jobs.h"
#include "server/messages/conditional.h"
#include "server/store/change.h"

namespace vitrine::server {
namespace {

constexpr double kMostAccuracy = 1e6;  // largest allowed `accuracy`, in the model's unit

// Checks whether an order can be carried out now, and returns its faults. The webhook must be
// allowed. The upload must be complete and accessible to the caller. The model to replace must
// exist.
FieldFaults check(const ModelOrder& order, const Uploading<Upload>& upload, const Request& request,
                  Services& services) {
  FieldFaults faults = check_webhook(order.webhook, services);
  const bool is_own =
      upload && (upload->token == request.caller->token || request.caller->role >= Role::kAdmin);
  if (!is_own) {
    faults.push_back({"upload", "the id of an upload of this token; it has none with that id"});
  } else if (!upload->is_length_known) {
    faults.push_back({"upload", "a complete upload; state its Upload-Length"});
  } else if (!upload->is_whole()) {
    faults.push_back({"upload", fmt::format("a complete upload; {} of {} bytes have arrived",
                                            upload->offset, upload->length)});
  }
  if (!order.replace) return faults;
  const auto model = services.catalogue.find(*order.replace);
  if (!model || !*model) faults.push_back({"replace", "the id of an existing model"});
  return faults;
}

// Whether an upload may exist but cannot be read at the moment.
bool is_unreadable(const Uploading<Upload>& upload) {
  return !upload && upload.error().cause != UploadFault::kGone;
}

Response unreadable(const UploadFault& fault, const Request& request, Services& services) {
  const bool is_full = fault.cause == UploadFault::kNoRoom;
  return refused({is_full ? ErrorCode::kLimit : ErrorCode::kIo, fault.message}, request, services);
}

Response accepted(const JobRecord& job) {
  Response response = json_answer({{"job", job.id.to_string()}}, 202);
  response.fields = {{"Location", "/api/v1/jobs/" + job.id.to_string()}};
  return response;
}

// Whether an If-Match list matches the model. Accepts the entity tags of both the full and the
// public view, because a client may read the model without a token and then change it with a token.
bool matches(std::string_view list, const ModelRecord& model, const ModelView& view) {
  ModelView full = view, open = view;
  full.has_token = true;
  open.has_token = false;
  return matches_any(list, model_tag(model, full)) ||
         matches_any(list, model_tag(public_view(model), open));
}

Response model_has_changed(const Request& request) {
  return problem(412, "the model has changed since; read it again", request.id);
}

// Returns 412 if the request's If-Match does not match the current state of the model, else
// nullopt.
std::optional<Response> refuse_state(const ModelRecord& model, const Request& request,
                                     const Services& services) {
  const auto wanted = request.header.find(beast::http::field::if_match);
  if (wanted == request.header.end()) return std::nullopt;
  const auto list = wanted->value();
  if (matches({list.data(), list.size()}, model, view_for(request, services))) return std::nullopt;
  return model_has_changed(request);
}

// Returns the hash of the file that visitors see, or would see if the model were published.
const Sha256& public_file(const ModelRecord& model) {
  return model.public_part ? model.public_part->file : model.file;
}

// Returns the response to a failed change or removal: 412 if the request has If-Match and another
// request has changed the model since If-Match was checked. Otherwise calls refused().
Response refused_change(const Error& error, const ModelRecord& before, const Request& request,
                        Services& services) {
  const auto now = services.catalogue.find(before.id);
  const bool is_same = now && *now && (*now)->version == before.version;
  if (now && !is_same && request.header.count(beast::http::field::if_match) > 0)
    return model_has_changed(request);
  return refused(error, request, services);
}

// Calls `answer(record)` with the record of the model that the request names, even if it is a
// draft. Returns 404 if there is no such model, 412 if If-Match does not match it, and 500 or 503
// if an error occurs.
template <class Answer>
Response with_record(const Request& request, Services& services, Answer&& answer) {
  const auto model = services.catalogue.find(id_in<ModelId>(request));
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  if (auto refused = refuse_state(**model, request, services)) return *refused;
  return answer(**model);
}

void read_unit(Fields& fields, const nlohmann::json& body, std::string& unit) {
  const auto found = body.find("unit");
  if (found == body.end()) return;
  if (found->is_null()) return unit.clear();
  const auto* given = found->get_ptr<const std::string*>();
  if (given == nullptr || !(given->empty() || metres_per(*given)))
    return fields.fault("unit", "mm, cm, m, in, or empty if it is unknown");
  unit = *given;
}

void read_accuracy(Fields& fields, const nlohmann::json& body, std::optional<double>& accuracy) {
  const auto found = body.find("accuracy");
  if (found != body.end() && found->is_null()) accuracy.reset();
  fields.real("accuracy", 0, kMostAccuracy, accuracy);
}

// Reads `public_max_level`, the finest public level. Null makes all levels public, and so does a
// number above the model's finest level.
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

void read_presentation_in(Fields& fields, const nlohmann::json& body, Presentation& presentation) {
  const auto found = body.find("presentation");
  if (found == body.end()) return;
  read_presentation(*found, presentation, [&](const std::string& field, const std::string& wanted) {
    fields.fault(field.empty() ? "presentation" : "presentation." + field, wanted);
  });
}

// Returns the record with the changes in the body applied. Texts may be members of the body itself,
// as in responses to GET, or of its member "metadata", as in requests with POST.
tl::expected<ModelRecord, FieldFaults> changed(const ModelRecord& before,
                                               const nlohmann::json& body) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ModelRecord model = before;
  std::vector<std::string_view> known = metadata_names();
  known.insert(known.end(), {"metadata", "unit", "accuracy", "public_max_level", "presentation"});
  fields.only(known);
  ModelMetadata texts{.title = model.title,
                      .creator = model.creator,
                      .rights = model.rights,
                      .licence = model.licence,
                      .more = model.more};
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
  read_presentation_in(fields, body, model.presentation);
  return order_or_faults(std::move(model), std::move(faults));
}

}  // namespace

static Response make_model(const Request& request, Services& services) {
  const auto order = parse_model_order(request.body);
  if (!order) return invalid(order.error(), request);
  const auto once = idempotency_key(request);
  if (!once) return once.error();
  auto& jobs = services.scans.jobs();
  const auto begun = jobs.begun_by(*once);
  if (!begun) return refused_job(begun.error(), request, services);
  // Looks for the idempotency key before it calls check(). If the job has already begun, its upload
  // may no longer exist, and check() would fail.
  if (*begun) return accepted(**begun);
  const auto held = services.uploads.hold();
  const auto upload = services.uploads.find(order->upload);
  if (is_unreadable(upload)) return unreadable(upload.error(), request, services);
  if (const auto faults = check(*order, upload, request, services); !faults.empty())
    return invalid(faults, request);
  const auto job = jobs.add(PublishJobs::job_for(*order, upload->token), std::nullopt, *once);
  return job ? accepted(*job) : refused_job(job.error(), request, services);
}

static std::optional<Opening> model_to_change(const Request& request, Services& services) {
  return opening_of(id_in<ModelId>(request), /*has_token=*/true, services.models);
}

static Response change_model(const Request& request, Services& services) {
  return with_record(request, services, [&](const ModelRecord& before) {
    const auto wanted = changed(before, request.body);
    if (!wanted) return invalid(wanted.error(), request);
    // A change keeps the geometry, so the manifest before the change still gives the dimensions.
    const FoundModel shown = find_visible(before.id, /*has_token=*/true, services.models).model;
    const auto model = change(services.store, services.catalogue, *wanted, &services.quota);
    if (!model) return refused_change(model.error(), before, request, services);
    services.models.refresh();
    services.collector.hurry();
    const bool looks_new =
        public_file(before) != public_file(*model) || before.presentation != model->presentation;
    if (looks_new && services.order_posters) services.order_posters(model->id);
    Response response;
    response.type = "application/json";
    const ModelView view = view_for(request, services);
    response.body =
        shown && *shown ? model_json(*model, (*shown)->manifest(), view) : model_json(*model, view);
    response.etag = model_tag(*model, view);
    return response;
  });
}

static Response remove_model(const Request& request, Services& services) {
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

static constexpr std::string_view kModelOrdersComponents = R"json({
"parameters": {
  "ifMatch": {"name": "If-Match", "in": "header", "description": "The ETag of the model as last read; the response is 412 if the model has changed since",
    "schema": {"type": "string"}}
},
"schemas": {
  "Metadata": {"unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/MetadataTexts"}]},
  "MetadataTexts": {"type": "object", "properties": {
    "title": {"type": "string"}, "creator": {"type": "string"}, "rights": {"type": "string"}, "licence": {"type": "string"},
    "contributor": {"type": "string"}, "coverage": {"type": "string"}, "date": {"type": "string"}, "description": {"type": "string"},
    "identifier": {"type": "string"}, "language": {"type": "string"}, "publisher": {"type": "string"}, "relation": {"type": "string"},
    "source": {"type": "string"}, "subject": {"type": "string", "description": "Subjects, materials, periods and so on are separated by semicolons"}, "type": {"type": "string"},
    "material": {"type": "string"}, "technique": {"type": "string"}, "period": {"type": "string"}, "place": {"type": "string"},
    "collection": {"type": "string"}, "provenance": {"type": "string"},
    "rights_statement": {"type": "string", "description": "The URI of a statement of RightsStatements.org"},
    "persistent_identifier": {"type": "string", "description": "A URI"}, "doi": {"type": "string", "description": "A DOI without a resolver"},
    "scan_device": {"type": "string"}, "scan_calibration": {"type": "string"}, "scan_date": {"type": "string"}, "scan_software": {"type": "string"}}},
  "ModelOrder": {"type": "object", "required": ["upload"], "additionalProperties": false, "properties": {
    "upload": {"$ref": "#/components/schemas/Id"}, "metadata": {"$ref": "#/components/schemas/Metadata"},
    "publish": {"type": "boolean", "default": false, "description": "Whether to publish the model; otherwise it stays a draft"},
    "replace": {"anyOf": [{"$ref": "#/components/schemas/Id"}, {"type": "null"}], "description": "The model to replace"},
    "webhook": {"$ref": "#/components/schemas/Webhook"},
    "bits": {"anyOf": [{"const": "auto"}, {"const": 0}, {"type": "integer", "minimum": 10, "maximum": 16}], "default": "auto"},
    "placement": {"enum": ["midpoint", "pyramid"]}, "unit": {"enum": ["mm", "cm", "m", "in"], "description": "Unit of the coordinates if the file states none"},
    "up": {"enum": ["y", "z"], "default": "y"},
    "repairs": {"type": "array", "items": {"type": "string"},
      "description": "What the client's build of an uploaded .pmesh file changed or left out, in at most 16,384 bytes; ignored for a mesh, which the server builds"}}},
  "ModelChange": {"type": "object", "unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/MetadataTexts"}],
    "description": "Members not given keep their values", "properties": {
    "metadata": {"$ref": "#/components/schemas/Metadata"}, "unit": {"enum": ["", "mm", "cm", "m", "in"]},
    "accuracy": {"type": ["number", "null"], "minimum": 0, "description": "Accuracy of the scan in the model's unit"},
    "public_max_level": {"type": ["integer", "null"], "minimum": 0, "maximum": 255, "description": "The finest level that visitors can load; null for all levels"},
    "presentation": {"anyOf": [{"$ref": "#/components/schemas/Presentation"}, {"type": "null"}], "description": "Null restores the presentation of the file"}}}
}
})json";

static constexpr ApiRoute kModelOrderRoutes[] = {
    {.method = Method::kPost,
     .path = "/api/v1/models",
     .handler = make_model,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "makeModel",
             .summary = "Starts a job that builds a model from an upload. The model is new or "
                        "replaces another.",
             .parameters = "idempotencyKey",
             .request = "ModelOrder",
             .status = 202,
             .response = "JobStarted"}},
    {.method = Method::kPatch,
     .path = "/api/v1/models/{id}",
     .handler = change_model,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .opens = model_to_change,
     .doc = {.id = "changeModel",
             .summary =
                 "Changes a model's metadata, unit, accuracy, finest public level or presentation.",
             .parameters = "ifMatch",
             .request = "ModelChange",
             .response = "Model"}},
    {.method = Method::kDelete,
     .path = "/api/v1/models/{id}",
     .handler = remove_model,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "removeModel",
             .summary = "Deletes a model permanently.",
             .parameters = "ifMatch",
             .status = 204}},
};

const ApiNoun kModelOrders = {.routes = kModelOrderRoutes, .components = kModelOrdersComponents};

}  // namespace vitrine::server
