// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>

#include "codec/mesh/vertex_normals.h"
#include "codec/picture/write_picture.h"
#include "codec/render/material_pictures.h"
#include "codec/render/render.h"
#include "server/api/decoded_model.h"
#include "server/api/handlers.h"
#include "server/api/published.h"
#include "server/messages/query.h"
#include "server/records/links.h"

namespace vitrine::server {
namespace {

// Returns the width in the query, or the default width if the query has none. Returns nullopt if
// the width is not supported.
std::optional<unsigned> read_width(const Query& query) {
  const auto text = query.get("width");
  if (!text) return kPosterWidth;
  const auto* width = std::ranges::find_if(
      kPosterWidths, [&](unsigned w) { return *text == fmt::format("{}", w); });
  return width == std::end(kPosterWidths) ? std::nullopt : std::optional(*width);
}

// Returns the camera's framing for a poster: the view that the presentation defines for posters, or
// else its initial view, or else a default view.
Framing frame_of(const TriangleMesh& mesh, const Presentation& presentation, unsigned width) {
  const auto& view = presentation.poster ? presentation.poster : presentation.view;
  Framing frame = frame_around(mesh, width, view ? direction_of(*view) : Framing{}.toward);
  frame.width = frame.height = width;
  if (view) frame.pixel /= view->zoom;
  if (view && view->target) frame.centre = *view->target;
  return frame;
}

// Renders the model from the viewpoint of its posters, with one triangle per two pixels. More
// triangles would not be visible, because the model covers about half of the picture and hides half
// of its own triangles. The texture has up to four pixels per pixel of the poster, because part of
// the texture's area is unused.
Expected<std::vector<std::uint8_t>> make_poster(const PublishedModel& model, unsigned width) {
  const auto decoded =
      decoded_model(model, WantTriangles{std::uint64_t{width} * width / 2}, 2 * width);
  if (!decoded) return tl::unexpected(decoded.error());
  const TriangleMesh& mesh = decoded->mesh;
  const Framing frame = frame_of(mesh, model.record().presentation, width);
  if (decoded->texturing.empty()) return write_png(render(mesh, frame));
  auto pictures = decode_pictures(decoded->texturing, kShownMaps, Limits{}.pixels);
  if (!pictures) return tl::unexpected(pictures.error());
  const Textures textures(decoded->texturing, std::move(*pictures));
  return write_png(render({mesh, vertex_normals(mesh), &textures}, frame));
}

Expected<ExportCache::File> find_or_make_poster(const PublishedModel& model, unsigned width,
                                                ExportCache& cache) {
  const auto key = fmt::format("{} poster {} {}", to_hex(model.record().file), width,
                               key_of(model.record().presentation));
  return cache.find_or_make(key, [&] { return make_poster(model, width); });
}

}  // namespace

Expected<void> make_posters(const ModelId& id, Services& services) {
  Expected<void> made;
  if (!services.exports.keeps_files()) return made;
  for (const bool has_token : {false, true}) {
    const FoundModel found = find_visible(id, has_token, services.models).model;
    if (!found) made = tl::unexpected(found.error());
    if (!found || !*found) continue;
    for (const unsigned width : kPosterWidths) {
      const auto poster = find_or_make_poster(**found, width, services.exports);
      if (!poster) made = tl::unexpected(poster.error());
    }
  }
  return made;
}

static Response show_poster(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  const auto width = read_width(*query);
  if (!width) {
    const auto choice = fmt::format("one of {}", fmt::join(kPosterWidths, ", "));
    return problem(400, "a parameter is out of range", request.id, {{"width", choice}});
  }
  return with_model(request, services, [&](const auto& model) {
    const auto file = find_or_make_poster(*model, *width, services.exports);
    if (!file) return internal_error(file.error(), request, services);
    Response response;
    response.type = "image/png";
    response.caching = Caching::kRevalidate;
    response.etag = (*file)->etag;
    response.body = SharedBytes{*file, (*file)->bytes};
    return response;
  });
}

static constexpr std::string_view kPostersComponents = R"json({
"parameters": {
  "width": {"name": "width", "in": "query", "description": "Width and height in pixels",
    "schema": {"enum": [240, 480, 960], "default": 480}}
}
})json";

static constexpr ApiRoute kPosterRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/poster.png",
     .handler = show_poster,
     .executor = Executor::kCompute,
     .doc = {.id = "getPoster",
             .summary =
                 "Returns a square picture of the model in the view chosen for posters, or else "
                 "in the viewer's first view, on a transparent background.",
             .parameters = "width",
             .response = "image/png"}},
};

const ApiNoun kPosters = {.routes = kPosterRoutes, .components = kPostersComponents};

}  // namespace vitrine::server
