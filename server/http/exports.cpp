// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "codec/export/write_mesh.h"
#include "server/http/decoded_model.h"
#include "server/http/handlers.h"
#include "server/http/published.h"
#include "server/http/wish.h"

namespace vitrine {
namespace {

Expected<std::vector<std::uint8_t>> make_export(const PublishedModel& model, const Want& want,
                                                MeshFormat format) {
  const auto mesh = decoded_model(model, want);
  if (!mesh) return Unexpected(mesh.error());
  return write_mesh(*mesh, format, model.manifest().unit);
}

std::string_view media_type(MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return "application/ply";
    case MeshFormat::kGlb:
      return "model/gltf-binary";
    case MeshFormat::kObj:
      return "model/obj";
    case MeshFormat::kStl:
      return "model/stl";
    case MeshFormat::kDrc:
      return "application/octet-stream";
    case MeshFormat::kVrml:
      return "model/vrml";
  }
  return "application/octet-stream";
}

}  // namespace

Response export_model(const Request& request, Services& services) {
  const auto format = format_of_extension(request.parameters.format);
  if (!format) return problem(404, "export as glb, ply, obj, stl, drc or wrl", request.id);
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  return with_model(request, services, [&](const auto& model) {
    const auto wish = read_wish(*query, request.header, model->manifest());
    if (!wish) return problem(400, "a parameter is out of range", request.id, {wish.error()});
    const std::string key =
        fmt::format("{} {} {}", to_hex(model->record().file), request.parameters.format,
                    key_of(wish->want, model->manifest()));
    const auto file = services.exports.find_or_make(
        key, [&] { return make_export(*model, wish->want, *format); });
    if (!file) return internal_error(file.error(), request, services);
    Response response;
    response.type = media_type(*format);
    response.caching = Caching::kRevalidate;
    response.etag = (*file)->etag;
    response.fields = {{"Vary", "Save-Data"},
                       {"Content-Disposition",
                        fmt::format("attachment; filename=\"{}.{}\"",
                                    model->record().id.to_string(), request.parameters.format)}};
    response.body = SharedBytes{*file, (*file)->bytes};
    return response;
  });
}

}  // namespace vitrine
