// SPDX-License-Identifier: Apache-2.0
// Serves IIIF Presentation 3.0 manifests of models. The canvas of a manifest shows the model's
// poster, which every IIIF viewer can display. The model itself is a `rendering` of the canvas, for
// viewers that support glTF. Version 4 of the standard adds scenes, but is still a draft that
// viewers do not read.
#include <nlohmann/json.hpp>

#include "server/api/handlers.h"
#include "server/api/links.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kType =
    "application/ld+json;profile=\"http://iiif.io/api/presentation/3/context.json\"";

Json in_english(std::string_view text) {
  return {{"en", {text}}};
}

Json in_no_language(std::string_view text) {
  return {{"none", {text}}};
}

Json metadata(const ModelRecord& model) {
  Json all = Json::array();
  const auto add = [&](std::string_view label, std::string_view value) {
    if (!value.empty())
      all.push_back({{"label", in_english(label)}, {"value", in_no_language(value)}});
  };
  add("Creator", model.creator);
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

Json canvas(const std::string& self, const std::string& model) {
  const std::string id = self + "/canvas";
  const Json painting = {{"id", id + "/poster/annotation"},
                         {"type", "Annotation"},
                         {"motivation", "painting"},
                         {"body", picture(model, kCanvasWidth)},
                         {"target", id}};
  const Json page = {
      {"id", id + "/poster"}, {"type", "AnnotationPage"}, {"items", Json::array({painting})}};
  return {{"id", id},
          {"type", "Canvas"},
          {"width", kCanvasWidth},
          {"height", kCanvasWidth},
          {"items", Json::array({page})}};
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

// Whether `licence` may be the value of the IIIF property `rights`, which must be an http URL (not
// https) of one of these two sites.
bool may_be_rights(const std::string& licence) {
  return licence.starts_with("http://creativecommons.org/") ||
         licence.starts_with("http://rightsstatements.org/");
}

Json manifest(const ModelRecord& record, const std::string& origin) {
  const std::string id = record.id.to_string();
  const std::string model = origin + "/api/v1/models/" + id;
  const std::string self = origin + "/api/v1/iiif/" + id;
  Json json = {{"@context", "http://iiif.io/api/presentation/3/context.json"},
               {"id", self + "/manifest.json"},
               {"type", "Manifest"},
               {"label", in_no_language(record.title.empty() ? id : record.title)},
               {"metadata", metadata(record)}};
  if (!record.rights.empty()) {
    json["requiredStatement"] = {{"label", in_english("Rights")},
                                 {"value", in_no_language(record.rights)}};
  }
  if (may_be_rights(record.licence)) json["rights"] = record.licence;
  json["thumbnail"] = Json::array({picture(model, kThumbnailWidth)});
  json["homepage"] = Json::array({{{"id", origin + "/models/" + id},
                                   {"type", "Text"},
                                   {"label", in_english("Interactive viewer")},
                                   {"format", "text/html"}}});
  json["rendering"] = renderings(model);
  json["seeAlso"] = Json::array({{{"id", model + "/manifest"},
                                  {"type", "Dataset"},
                                  {"label", in_english("Levels of detail, sizes and errors")},
                                  {"format", "application/json"}}});
  json["items"] = Json::array({canvas(self, model)});
  return json;
}

}  // namespace

static Response show_iiif_manifest(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const Json json = manifest(model->record(), origin_of(request, services));
    return revalidated(kType, json.dump(-1, ' ', false, Json::error_handler_t::replace));
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
             .response = "IiifManifest"}},
    {.method = Method::kGet,
     .path = "/iiif/{id}/manifest.json",
     .handler = redirect_to_iiif,
     .executor = Executor::kInline},
};

const ApiNoun kIiif = {.routes = kIiifRoutes, .components = kIiifComponents};

}  // namespace vitrine::server
