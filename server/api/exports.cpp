// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "codec/export/write_mesh.h"
#include "server/api/decoded_model.h"
#include "server/api/detail_request.h"
#include "server/api/handlers.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"

namespace vitrine::server {
namespace {

Expected<std::vector<std::uint8_t>> make_export(const PublishedModel& model, const Want& want,
                                                MeshFormat format) {
  const auto mesh = decoded_model(model, want);
  if (!mesh) return tl::unexpected(mesh.error());
  return write_mesh(*mesh, format, model.manifest().unit);
}

constexpr FixedText kSummary = concatenate("Exports a level of detail as ", kExportExtensions,
                                           ". Without a detail request, exports all detail.");

}  // namespace

static Response export_model(const Request& request, Services& services) {
  const auto format = format_of_extension(format_in(request));
  if (!format) return problem(404, "export as " + std::string(kExportExtensions), request.id);
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  return with_model(request, services, [&](const auto& model) {
    const auto detail = read_detail_request(*query, request.header, model->manifest());
    if (!detail) return problem(400, "a parameter is out of range", request.id, {detail.error()});
    const std::string key =
        fmt::format("{} {} {}", to_hex(model->record().file), format_in(request),
                    key_of(detail->want, model->manifest()));
    const auto file = services.exports.find_or_make(
        key, [&] { return make_export(*model, detail->want, *format); });
    if (!file) return internal_error(file.error(), request, services);
    Response response;
    response.type = row_of(*format).media_type;
    response.caching = Caching::kRevalidate;
    response.etag = (*file)->etag;
    response.fields = {
        {"Vary", "Save-Data"},
        {"Content-Disposition", fmt::format("attachment; filename=\"{}.{}\"",
                                            model->record().id.to_string(), format_in(request))}};
    response.body = SharedBytes{*file, (*file)->bytes};
    return response;
  });
}

static constexpr std::string_view kExportsComponents = R"json({
"parameters": {
  "path.format": {"name": "format", "in": "path", "required": true,
    "schema": {"enum": ["glb", "ply", "obj", "stl", "drc", "wrl"]}}
}
})json";

static constexpr ApiRoute kExportRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/export.{format}",
     .handler = export_model,
     .executor = Executor::kCompute,
     .doc = {.id = "exportModel",
             .summary = kSummary,
             .parameters = "triangles error bytes level kbps seconds saveData",
             .response = "application/octet-stream"}},
};

const ApiNoun kExports = {.routes = kExportRoutes, .components = kExportsComponents};

}  // namespace vitrine::server
