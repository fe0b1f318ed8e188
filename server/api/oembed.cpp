// SPDX-License-Identifier: Apache-2.0
// Serves oEmbed [oEmbed]: returns the HTML frame with which other sites embed a model's page.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/core/html.h"
#include "codec/core/parse_number.h"
#include "server/api/handlers.h"
#include "server/api/published.h"
#include "server/messages/query.h"
#include "server/records/links.h"

namespace vitrine::server {
namespace {

struct Room {
  std::uint32_t width = 640, height = 480;
};

// Limits `room`, the size of the embedded frame, to `maxwidth` and `maxheight` of the query. If one
// of these parameters is invalid, returns its fault.
std::optional<ParameterFault> read_room(const Query& query, Room& room) {
  for (const auto& [name, side] :
       {std::pair("maxwidth", &room.width), std::pair("maxheight", &room.height)}) {
    const auto text = query.get(name);
    if (!text) continue;
    const auto most = parse_number<std::uint32_t>(*text);
    if (!most || *most == 0) return ParameterFault{name, "a whole number of pixels, 1 or more"};
    *side = std::min(*side, *most);
  }
  return std::nullopt;
}

// Returns the model whose page has this URL. Returns nullopt if the URL is not the page of a model
// on this server.
std::optional<ModelId> model_of(std::string_view url, const std::string& origin) {
  const std::string pages = origin + "/models/";
  if (!url.starts_with(pages)) return std::nullopt;
  url.remove_prefix(pages.size());
  return ModelId::parse(url.substr(0, url.find_first_of("?#")));
}

nlohmann::ordered_json description(const ModelRecord& model, const std::string& origin,
                                   const Room& room) {
  const std::string id = model.id.to_string();
  const std::string page = origin + "/models/" + id;
  nlohmann::ordered_json json = {{"version", "1.0"},
                                 {"type", "rich"},
                                 {"title", model.title},
                                 {"provider_name", "Vitrine"},
                                 {"provider_url", origin + "/"},
                                 {"width", room.width},
                                 {"height", room.height}};
  json["html"] = fmt::format(
      "<iframe src=\"{}\" width=\"{}\" height=\"{}\" title=\"{}\" style=\"border:0\" "
      "allow=\"fullscreen; web-share; xr-spatial-tracking\" loading=\"lazy\"></iframe>",
      page, room.width, room.height, escape_html(model.title));
  if (!model.creator.empty()) json["author_name"] = model.creator;
  if (std::min(room.width, room.height) >= kThumbnailWidth) {
    json["thumbnail_url"] =
        fmt::format("{}/api/v1/models/{}/poster.png?width={}", origin, id, kThumbnailWidth);
    json["thumbnail_width"] = json["thumbnail_height"] = kThumbnailWidth;
  }
  return json;
}

}  // namespace

static std::optional<Opening> model_at_url(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  const auto url = query ? query->get("url") : std::nullopt;
  const auto id = url ? model_of(*url, origin_of(request, services)) : std::nullopt;
  return id ? opening_of(*id, /*has_token=*/false, services.models) : std::nullopt;
}

static Response show_oembed(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  if (query->get("format").value_or("json") != "json")
    return problem(501, "", request.id);  // oEmbed demands 501 for an unsupported format
  Room room;
  if (const auto fault = read_room(*query, room))
    return problem(400, "a parameter is out of range", request.id, {*fault});
  const std::string origin = origin_of(request, services);
  const auto url = query->get("url");
  if (!url) return problem(400, "a parameter is missing", request.id, {{"url", "a model's page"}});
  const auto id = model_of(*url, origin);
  if (!id) return problem(404, "the url is not a model's page on this server", request.id);
  const auto answer = [&](const auto& model) {
    return revalidated("application/json",
                       description(model->record(), origin, room)
                           .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  };
  return with_found(find_visible(*id, false, services.models).model, request, services, answer);
}

static constexpr std::string_view kOembedComponents = R"json({
"parameters": {
  "url": {"name": "url", "in": "query", "required": true, "description": "Address of a model's page on this server",
    "schema": {"type": "string", "format": "uri"}},
  "maxwidth": {"name": "maxwidth", "in": "query", "schema": {"type": "integer", "minimum": 1}},
  "maxheight": {"name": "maxheight", "in": "query", "schema": {"type": "integer", "minimum": 1}},
  "format": {"name": "format", "in": "query", "schema": {"enum": ["json"], "default": "json"}}
},
"schemas": {
  "Oembed": {"type": "object", "required": ["version", "type", "html", "width", "height"], "properties": {
    "version": {"const": "1.0"}, "type": {"const": "rich"}, "title": {"type": "string"}, "author_name": {"type": "string"},
    "provider_name": {"type": "string"}, "provider_url": {"type": "string"}, "html": {"type": "string"},
    "width": {"type": "integer"}, "height": {"type": "integer"}, "thumbnail_url": {"type": "string"},
    "thumbnail_width": {"type": "integer"}, "thumbnail_height": {"type": "integer"}}}
}
})json";

static constexpr ApiRoute kOembedRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/oembed",
     .handler = show_oembed,
     .executor = Executor::kWorker,
     .opens = model_at_url,
     .doc = {.id = "getOembed",
             .summary =
                 "Returns the code by which another site embeds a model's page (oEmbed 1.0).",
             .parameters = "url maxwidth maxheight format",
             .response = "Oembed",
             .may_be_gzip = true}},
};

static constexpr ApiTag kOembedTags[] = {
    {.name = "oembed", .description = "Embedding of a model's page in other sites."}};

const ApiNoun kOembed = {
    .routes = kOembedRoutes, .components = kOembedComponents, .tags = kOembedTags};

}  // namespace vitrine::server
