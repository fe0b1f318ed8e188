// SPDX-License-Identifier: Apache-2.0
#include "server/http/posters.h"

#include <fmt/format.h>

#include <algorithm>

#include "codec/render/png_file.h"
#include "codec/render/render.h"
#include "server/http/decoded_model.h"
#include "server/http/handlers.h"
#include "server/http/published.h"
#include "server/http/query.h"

namespace vitrine {
namespace {

// Nothing where the query asks for another size than there is.
std::optional<unsigned> read_width(const Query& query) {
  const auto text = query.get("width");
  if (!text) return kPosterWidth;
  const auto* width = std::ranges::find_if(
      kPosterWidths, [&](unsigned w) { return *text == fmt::format("{}", w); });
  return width == std::end(kPosterWidths) ? std::nullopt : std::optional(*width);
}

// As the viewer shows the model at first. One triangle for two pixels, of which the model covers
// about half and hides half of its own: more would not be seen.
Expected<std::vector<std::uint8_t>> make_poster(const PublishedModel& model, unsigned width) {
  const auto mesh = decoded_model(model, WantTriangles{std::uint64_t{width} * width / 2});
  if (!mesh) return Unexpected(mesh.error());
  Framing frame = frame_around(*mesh, width);
  frame.width = frame.height = width;
  return write_png(render(*mesh, frame));
}

}  // namespace

Response show_poster(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  const auto width = read_width(*query);
  if (!width) {
    const auto choice = fmt::format("one of {}", fmt::join(kPosterWidths, ", "));
    return problem(400, "a parameter is out of range", request.id, {{"width", choice}});
  }
  return with_model(request, services, [&](const auto& model) {
    const auto key = fmt::format("{} poster {}", to_hex(model->record().file), *width);
    const auto file =
        services.exports.find_or_make(key, [&] { return make_poster(*model, *width); });
    if (!file) return internal_error(file.error(), request, services);
    Response response;
    response.type = "image/png";
    response.caching = Caching::kRevalidate;
    response.etag = (*file)->etag;
    response.body = SharedBytes{*file, (*file)->bytes};
    return response;
  });
}

}  // namespace vitrine
