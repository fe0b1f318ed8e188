// SPDX-License-Identifier: Apache-2.0
// Serves IIIF manifests of models (Presentation 3.0 and 4.0 [IIIF]), and a collection that lists
// all models. In a manifest of version 3, a canvas shows the model's poster, which every IIIF
// viewer can display, and the model itself is a `rendering`. In a manifest of version 4, a scene
// shows the model.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "server/api/handlers.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/metadata/rights.h"
#include "server/records/collection_page.h"
#include "server/records/links.h"
#include "server/records/record_format.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kContext3 = "http://iiif.io/api/presentation/3/context.json";
constexpr std::string_view kContext4 = "http://iiif.io/api/presentation/4/context.json";
constexpr std::string_view kType = "application/ld+json";

Response iiif_answer(const Json& json) {
  const std::string type =
      fmt::format("{};profile=\"{}\"", kType, json.at("@context").get_ref<const std::string&>());
  return revalidated(type, json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Json in_english(std::string_view text) {
  return {{"en", {text}}};
}

Json in_no_language(std::string_view text) {
  return {{"none", {text}}};
}

constexpr std::pair<const char*, const char*> kIdentifiers[] = {
    {"identifier", "Inventory number"}, {"persistent_identifier", "Persistent identifier"}};

Json metadata(const ModelRecord& model) {
  const DescribedModel described(model, "");
  Json all = Json::array();
  const auto add = [&](std::string_view label, std::string_view value) {
    if (!value.empty())
      all.push_back({{"label", in_english(label)}, {"value", in_no_language(value)}});
  };
  add("Creator", model.creator);
  for (const auto& [name, label] : kIdentifiers)
    add(label, described.text(name));
  add("DOI", described.doi_url());
  add("Licence", model.licence);
  add("Unit", model.unit);
  add("Triangles", std::to_string(model.faces));
  return all;
}

Json picture(const std::string& model, unsigned width) {
  return {{"id", model + "/poster.png?width=" + std::to_string(width)},
          {"type", "Image"},
          {"format", "image/png"},
          {"width", width},
          {"height", width}};
}

// If the model has notes, adds a link to the annotation page with these notes to `container`.
void add_annotations(Json& container, const std::string& self, const ModelRecord& record) {
  if (record.notes == 0) return;
  container["annotations"] =
      Json::array({{{"id", self + "/annotations.json"}, {"type", "AnnotationPage"}}});
}

Json canvas(const std::string& self, const std::string& model, const ModelRecord& record) {
  const std::string id = self + "/canvas";
  const Json painting = {{"id", id + "/poster/annotation"},
                         {"type", "Annotation"},
                         {"motivation", "painting"},
                         {"body", picture(model, kCanvasWidth)},
                         {"target", id}};
  const Json page = {
      {"id", id + "/poster"}, {"type", "AnnotationPage"}, {"items", Json::array({painting})}};
  Json json = {{"id", id},
               {"type", "Canvas"},
               {"width", kCanvasWidth},
               {"height", kCanvasWidth},
               {"items", Json::array({page})}};
  add_annotations(json, self, record);
  return json;
}

Json renderings(const std::string& model) {
  return Json::array({{{"id", model + "/export.glb"},
                       {"type", "Model"},
                       {"label", in_english("3D model (glTF binary)")},
                       {"format", "model/gltf-binary"}},
                      {{"id", model + "/export.ply"},
                       {"type", "Model"},
                       {"label", in_english("3D model (PLY)")},
                       {"format", "application/ply"}}});
}

Json label_of(const ModelRecord& record) {
  return in_no_language(record.title.empty() ? record.id.to_string() : record.title);
}

Json thumbnails(const std::string& model) {
  return Json::array({picture(model, kThumbnailWidth)});
}

std::string text_of(const ModelRecord& record, const std::string& element) {
  const auto found = record.more.find(element);
  return found == record.more.end() ? std::string() : found->second;
}

// Returns the institution that publishes the model.
Json provider(const std::string& publisher, const std::string& origin) {
  return Json::array({{{"id", origin + "/"},
                       {"type", "Agent"},
                       {"label", in_no_language(publisher)},
                       {"homepage", Json::array({{{"id", origin + "/"},
                                                  {"type", "Text"},
                                                  {"label", in_no_language(publisher)},
                                                  {"format", "text/html"}}})}}});
}

// Returns links to the list of the model's levels of detail and to its metadata records.
Json see_also(const std::string& model) {
  Json all = Json::array({{{"id", model + "/manifest"},
                           {"type", "Dataset"},
                           {"label", in_english("Levels of detail, sizes and errors")},
                           {"format", "application/json"}}});
  for (const RecordFormat* format : kRecordFormats) {
    all.push_back({{"id", fmt::format("{}/{}", model, format->file)},
                   {"type", "Dataset"},
                   {"label", in_english(format->label)},
                   {"format", "application/xml"},
                   {"profile", format->xml_namespace}});
  }
  return all;
}

// Returns the members that IIIF manifests of versions 3 and 4 have in common: all except `items`.
Json description(const ModelRecord& record, const std::string& origin, std::string_view context,
                 const std::string& self) {
  const std::string id = record.id.to_string();
  const std::string model = origin + "/api/v1/models/" + id;
  Json json = {{"@context", context},
               {"id", self + "/manifest.json"},
               {"type", "Manifest"},
               {"label", label_of(record)},
               {"metadata", metadata(record)}};
  if (const std::string text = text_of(record, "description"); !text.empty())
    json["summary"] = in_no_language(text);
  if (!record.rights.empty()) {
    json["requiredStatement"] = {{"label", in_english("Rights")},
                                 {"value", in_no_language(record.rights)}};
  }
  if (const auto rights = rights_url(record.licence)) json["rights"] = *rights;
  if (const std::string publisher = text_of(record, "publisher"); !publisher.empty())
    json["provider"] = provider(publisher, origin);
  json["thumbnail"] = thumbnails(model);
  json["homepage"] = Json::array({{{"id", origin + "/models/" + id},
                                   {"type", "Text"},
                                   {"label", in_english("Interactive viewer")},
                                   {"format", "text/html"}}});
  json["rendering"] = renderings(model);
  json["seeAlso"] = see_also(model);
  return json;
}

// Returns a scene that shows the model as GLB, which is in metres if the model's unit is known.
Json scene(const std::string& self, const std::string& model, const ModelRecord& record) {
  const std::string id = self + "/scene";
  Json annotation = {{"id", id + "/model/annotation"},
                     {"type", "Annotation"},
                     {"motivation", Json::array({"painting"})},
                     {"body",
                      {{"id", model + "/export.glb"},
                       {"type", "Model"},
                       {"label", in_english("3D model (glTF binary)")},
                       {"format", "model/gltf-binary"}}},
                     {"target", {{"id", id}, {"type", "Scene"}}}};
  Json page = {{"id", id + "/model"},
               {"type", "AnnotationPage"},
               {"items", Json::array({std::move(annotation)})}};
  Json json = {{"id", id}, {"type", "Scene"}, {"label", label_of(record)}};
  if (!record.unit.empty())
    json["spatialScale"] = {{"type", "Quantity"}, {"quantityValue", 1.0}, {"unit", "m"}};
  json["items"] = Json::array({std::move(page)});
  add_annotations(json, self, record);
  return json;
}

std::string collection_id(const std::string& origin, const std::optional<ModelId>& cursor = {}) {
  return origin + "/api/v1/iiif/collection.json" + (cursor ? "?cursor=" + cursor->to_string() : "");
}

Json collection(const std::string& id, std::string_view label) {
  return {{"@context", kContext3},
          {"id", id},
          {"type", "Collection"},
          {"label", in_english(label)},
          {"items", Json::array()}};
}

// Returns a collection with one sub-collection per page, because Presentation 3.0 has no paging.
Json collection_of_pages(const std::vector<ModelId>& cursors, const std::string& origin) {
  Json json = collection(collection_id(origin), "All objects");
  for (const ModelId& cursor : cursors) {
    const std::size_t part = json["items"].size() + 1;
    json["items"].push_back({{"id", collection_id(origin, cursor)},
                             {"type", "Collection"},
                             {"label", in_english(fmt::format("All objects, part {}", part))}});
  }
  return json;
}

void add_manifests(Json& json, const std::vector<ModelRecord>& models, const std::string& origin) {
  for (const ModelRecord& record : models) {
    const std::string id = record.id.to_string();
    json["items"].push_back(
        {{"id", fmt::format("{}/api/v1/iiif/{}/manifest.json", origin, id)},
         {"type", "Manifest"},
         {"label", label_of(record)},
         {"thumbnail", thumbnails(fmt::format("{}/api/v1/models/{}", origin, id))}});
  }
}

Json collection_of_models(const std::vector<ModelRecord>& models,
                          const std::optional<ModelId>& cursor, const std::string& origin) {
  Json json =
      collection(collection_id(origin, cursor), cursor ? "A part of all objects" : "All objects");
  if (cursor)
    json["partOf"] = Json::array({{{"id", collection_id(origin)}, {"type", "Collection"}}});
  add_manifests(json, models, origin);
  return json;
}

// Returns the IIIF collection of the models that belong to a collection of the museum.
Response named_collection(const std::string& name, const Request& request, Services& services) {
  const auto models = list_public({.facets = {{"collection", name}}}, services);
  if (!models) return internal_error(models.error(), request, services);
  if (models->empty()) return problem(404, "there is no such collection", request.id);
  const std::string origin = origin_of(request, services);
  Json json = collection(origin + collection_iiif_path(name), "");
  json["label"] = in_no_language(name);
  json["homepage"] = Json::array({{{"id", origin + collection_path(name)},
                                   {"type", "Text"},
                                   {"label", in_no_language(name)},
                                   {"format", "text/html"}}});
  add_manifests(json, *models, origin);
  return iiif_answer(json);
}

}  // namespace

static Response show_iiif_manifest(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const std::string origin = origin_of(request, services), id = model->record().id.to_string();
    const std::string self = origin + "/api/v1/iiif/" + id;
    Json json = description(model->record(), origin, kContext3, self);
    json["items"] = Json::array({canvas(self, origin + "/api/v1/models/" + id, model->record())});
    return iiif_answer(json);
  });
}

static Response show_iiif_scene(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const std::string origin = origin_of(request, services), id = model->record().id.to_string();
    const std::string self = origin + "/api/v1/iiif/4/" + id;
    Json json = description(model->record(), origin, kContext4, self);
    json["items"] = Json::array({scene(self, origin + "/api/v1/models/" + id, model->record())});
    return iiif_answer(json);
  });
}

static Response show_iiif_collection(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  if (const auto name = query ? query->get("collection") : std::nullopt;
      name && !query->get("cursor"))
    return named_collection(std::string(*name), request, services);
  const std::string origin = origin_of(request, services);
  return in_pages(
      request, services,
      [&](const auto& cursors) { return iiif_answer(collection_of_pages(cursors, origin)); },
      [&](const auto& models, const auto& cursor) {
        return iiif_answer(collection_of_models(models, cursor, origin));
      });
}

static Response redirect_to_iiif(const Request& request, Services& services) {
  Response response;
  response.status = 308;
  response.fields = {{"Location", origin_of(request, services) + "/api/v1/iiif/" +
                                      id_in<ModelId>(request).to_string() + "/manifest.json"}};
  return response;
}

static constexpr std::string_view kIiifComponents = R"json({
"schemas": {
  "IiifManifest": {"type": "object", "required": ["@context", "id", "type", "label", "items"], "properties": {
    "@context": {"const": "http://iiif.io/api/presentation/3/context.json"}, "id": {"type": "string"}, "type": {"const": "Manifest"},
    "label": {"type": "object"}, "items": {"type": "array", "items": {"type": "object"}}}},
  "IiifScene": {"type": "object", "required": ["@context", "id", "type", "label", "items"], "properties": {
    "@context": {"const": "http://iiif.io/api/presentation/4/context.json"}, "id": {"type": "string"}, "type": {"const": "Manifest"},
    "label": {"type": "object"}, "items": {"type": "array", "items": {"type": "object"}}}},
  "IiifCollection": {"type": "object", "required": ["@context", "id", "type", "label", "items"], "properties": {
    "@context": {"const": "http://iiif.io/api/presentation/3/context.json"}, "id": {"type": "string"}, "type": {"const": "Collection"},
    "label": {"type": "object"}, "items": {"type": "array", "items": {"type": "object"}}}}
}
})json";

static constexpr ApiRoute kIiifRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/iiif/{id}/manifest.json",
     .handler = show_iiif_manifest,
     .executor = Executor::kWorker,
     .doc = {.id = "getIiifManifest",
             .summary = "Returns the model's IIIF Presentation 3.0 manifest: a canvas with the "
                        "poster, and the model as its rendering.",
             .response = "IiifManifest",
             .response_type = kType,
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/api/v1/iiif/4/{id}/manifest.json",
     .handler = show_iiif_scene,
     .executor = Executor::kWorker,
     .doc = {.id = "getIiifScene",
             .summary = "Returns the model's IIIF Presentation 4.0 manifest: a scene with the "
                        "model.",
             .response = "IiifScene",
             .response_type = kType,
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/api/v1/iiif/collection.json",
     .handler = show_iiif_collection,
     .executor = Executor::kWorker,
     .doc = {.id = "getIiifCollection",
             .summary =
                 "Returns an IIIF Presentation 3.0 collection of all published models, "
                 "newest first, or of a collection. Lists collections of 10,000 models each if all "
                 "are more.",
             .parameters = "cursor collection",
             .response = "IiifCollection",
             .response_type = kType,
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/iiif/{id}/manifest.json",
     .handler = redirect_to_iiif,
     .executor = Executor::kInline},
};

static constexpr ApiTag kIiifTags[] = {
    {.name = "iiif", .description = "Manifests of IIIF Presentation 3 and 4."}};

const ApiNoun kIiif = {.routes = kIiifRoutes, .components = kIiifComponents, .tags = kIiifTags};

}  // namespace vitrine::server
