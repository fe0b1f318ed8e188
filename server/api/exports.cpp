// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "codec/build/exported_texture.h"
#include "codec/core/parse_number.h"
#include "codec/core/sha256.h"
#include "codec/export/write_mesh.h"
#include "codec/export/zip.h"
#include "server/api/decoded_model.h"
#include "server/api/detail_request.h"
#include "server/api/handlers.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/export/export_choices.h"
#include "server/export/export_kind.h"
#include "server/messages/content_coding.h"
#include "server/messages/download_name.h"

namespace vitrine::server {
namespace {

using TextureSide = std::optional<std::uint32_t>;

// Returns which pictures an export contains, by their roles. If the format stores pictures in
// companion files, as OBJ does, only a zip export contains pictures.
PictureRoles roles_of(ExportKind kind) {
  return kind.is_zip || !has_companions(kind.format) ? roles_in(kind.format) : PictureRoles();
}

// Whether the export is a text file, which gzip compresses well.
bool is_text(ExportKind kind) {
  return !kind.is_zip && (kind.format == MeshFormat::kObj || kind.format == MeshFormat::kVrml);
}

// An export as a client requests it.
struct ExportOrder {
  ExportKind kind;
  Want want;
  TextureSide texture_side;
  ExportChoices choices;
  FileDescription about;  // make_export() sets `level` and `error`
};

Expected<std::vector<std::uint8_t>> make_export(const PublishedModel& model, ExportOrder order) {
  const ExportKind kind = order.kind;
  auto decoded = decoded_model(model, order.want, order.texture_side, roles_of(kind));
  if (!decoded) return tl::unexpected(decoded.error());
  order.about.level = decoded->detail.level;
  order.about.error = decoded->detail.error;
  ExportOptions options =
      export_options(order.choices, kind.format, model.manifest().unit, std::move(order.about),
                     {decoded->detail.grid_origin, decoded->detail.grid_step});
  Expected<std::vector<CoarserLevel>> coarser;
  if (order.choices.has_levels) coarser = levels_below(*decoded, model);
  if (!coarser) return tl::unexpected(coarser.error());
  options.coarser = *coarser;
  auto files = write_textured_mesh(decoded->mesh, std::move(decoded->texturing), kind.format,
                                   model.record().id.to_string(), options);
  if (!files) return tl::unexpected(files.error());
  return kind.is_zip ? zip(*files) : std::move(files->front().bytes);
}

// Reads the query parameter `texture`.
tl::expected<TextureSide, ParameterFault> read_texture_side(const Query& query) {
  const auto text = query.get("texture");
  const auto side = text ? parse_number<std::uint32_t>(*text) : std::nullopt;
  if (text && (!side || *side > kMaxPictureSide)) {
    return tl::unexpected(
        ParameterFault{"texture", fmt::format("a whole number from 0 to {}", kMaxPictureSide)});
  }
  return side;
}

// Reads the query parameters `unit`, `up`, `compression` and `lod`.
tl::expected<ExportChoices, ParameterFault> read_export_choices(const Query& query,
                                                                MeshFormat format,
                                                                std::string_view model_unit) {
  const auto choices = read_choices({.unit = query.get("unit"),
                                     .up = query.get("up"),
                                     .compression = query.get("compression"),
                                     .lod = query.get("lod")},
                                    format);
  if (!choices) {
    return tl::unexpected(
        ParameterFault{std::string(choices.error().name), choices.error().wanted});
  }
  if (!check_unit(*choices, model_unit))
    return tl::unexpected(
        ParameterFault{"unit", "none, because the unit of this model is unknown"});
  return *choices;
}

FileDescription description_of(const ModelRecord& record, const std::string& origin) {
  return {.title = record.title,
          .creator = record.creator,
          .rights = record.rights,
          .licence = record.licence,
          .source = fmt::format("{}/models/{}", origin, record.id.to_string())};
}

// Returns the export compressed by gzip. `plain` is the uncompressed export, or null if the cache
// does not have it.
Expected<std::vector<std::uint8_t>> make_compressed(const ExportCache::File& plain,
                                                    const PublishedModel& model,
                                                    const ExportOrder& order) {
  if (plain) return gzip(plain->bytes);
  return make_export(model, order).map(gzip);
}

// Returns the part of an export's cache key that identifies the descriptive texts and the choices
// (unit, up axis and so on).
std::string key_of(const ExportOrder& order) {
  std::string texts;
  const FileDescription& about = order.about;
  for (const std::string* text :
       {&about.title, &about.creator, &about.rights, &about.licence, &about.source}) {
    texts += *text + '\0';
  }
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(texts.data()), texts.size());
  const ExportChoices& choices = order.choices;
  return fmt::format("{} {} {} {} {}", to_hex(sha256(bytes)), choices.unit, name_of(choices.up),
                     static_cast<int>(choices.compression), choices.has_levels);
}

// Returns the part of an export's cache key that identifies the texture. Texture sizes that select
// the same pictures give the same key.
std::string key_of(TextureSide side, ExportKind kind, const Manifest& manifest) {
  if (!side) return "fitting";
  return fmt::format("{}", fmt::join(pictures_to_export(manifest, 0, side, roles_of(kind)), ","));
}

constexpr std::string_view kOwnParameters[] = {"texture", "unit", "up", "compression", "lod"};

constexpr FixedText kMeshMediaTypes = join(
    kExportFormats, [](const ExportFormat& row) { return row.media_type; }, " ", " ");
constexpr FixedText kMediaTypes = concatenate(kMeshMediaTypes, " application/zip");

constexpr FixedText kSummary =
    concatenate("Exports a level of detail as ", kExportExtensions, ", or as ", kZipExtensions,
                ". Without a detail request, exports all detail. Files state title, creator, "
                "rights, licence, source, level and error. GLB and USDZ files and zips contain "
                "the texture, with pictures in JPEG, or in PNG if the "
                "surface is not opaque.");

}  // namespace

static Response export_model(const Request& request, Services& services) {
  const std::string name =
      fmt::format("{}.{}", id_in<ModelId>(request).to_string(), format_in(request));
  const auto kind = export_kind_of(name);
  if (!kind) {
    return problem(404,
                   fmt::format("export as {}, or as {}", std::string_view(kExportExtensions),
                               std::string_view(kZipExtensions)),
                   request.id);
  }
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  return with_model(request, services, [&](const auto& model) {
    const Manifest& manifest = model->manifest();
    const auto detail = read_detail_request(*query, request.header, manifest, kOwnParameters);
    if (!detail) return problem(400, "a parameter is out of range", request.id, {detail.error()});
    const auto side = read_texture_side(*query);
    if (!side) return problem(400, "a parameter is out of range", request.id, {side.error()});
    const auto choices = read_export_choices(*query, kind->format, manifest.unit);
    if (!choices) return problem(400, "a parameter is out of range", request.id, {choices.error()});
    const ExportOrder order{.kind = *kind,
                            .want = detail->want,
                            .texture_side = *side,
                            .choices = *choices,
                            .about = description_of(model->record(), origin_of(request, services))};
    const std::string key = fmt::format(
        "{} {} {} {} {} {}", to_hex(model->record().file), name, key_of(*side, *kind, manifest),
        key_of(detail->want, manifest), key_of(order), key_of(model->record().presentation));
    const bool is_compressed = is_text(*kind) && takes_gzip(request.header);
    const auto file = services.exports.find_or_make(
        is_compressed ? key + " gzip" : key, [&]() -> Expected<std::vector<std::uint8_t>> {
          return is_compressed ? make_compressed(services.exports.find(key), *model, order)
                               : make_export(*model, order);
        });
    if (!file) return internal_error(file.error(), request, services);
    Response response;
    response.type = kind->is_zip ? "application/zip" : row_of(kind->format).media_type;
    response.caching = Caching::kRevalidate;
    response.etag = (*file)->etag;
    response.fields = {{"Vary", is_text(*kind) ? "Save-Data, Accept-Encoding" : "Save-Data"},
                       {"Content-Disposition",
                        attachment_named(model->record().title, model->record().id.to_string(),
                                         format_in(request))}};
    if (is_compressed) response.fields.emplace_back("Content-Encoding", "gzip");
    response.body = SharedBytes{*file, (*file)->bytes};
    return response;
  });
}

static constexpr std::string_view kExportsComponents = R"json({
"parameters": {
  "path.format": {"name": "format", "in": "path", "required": true,
    "schema": {"enum": ["glb", "ply", "obj", "stl", "drc", "wrl", "3mf", "usdz", "ply.zip", "obj.zip", "wrl.zip"]}},
  "texture": {"name": "texture", "in": "query",
    "description": "Largest width of the texture's pictures in pixels, for GLB, USDZ and zips; 0 exports vertex colours instead. By default, a size that fits the level of detail",
    "schema": {"type": "integer", "minimum": 0, "maximum": 16384}},
  "unit": {"name": "unit", "in": "query",
    "description": "Unit of the file. By default mm for STL and 3MF, m for USDZ, and the unit of the model for other formats. GLB and VRML files are in metres. If the unit of the model is unknown, leave this out; the file then states that it is unknown",
    "schema": {"enum": ["mm", "cm", "m", "in"]}},
  "up": {"name": "up", "in": "query",
    "description": "Axis of the file that points up. By default z for STL and y for other formats. In GLB and VRML files, y points up, and in 3MF files z",
    "schema": {"enum": ["y", "z"]}},
  "compression": {"name": "compression", "in": "query",
    "description": "Compression of a GLB: EXT_meshopt_compression or KHR_draco_mesh_compression. Positions are rounded to the lattice of the level of detail. By default, files are not compressed",
    "schema": {"enum": ["none", "meshopt", "draco"]}},
  "lod": {"name": "lod", "in": "query",
    "description": "msft: a GLB that also holds coarser levels of detail, each with at most a quarter of the triangles of the one before, down to the base mesh, for clients of the glTF extension MSFT_lod. All levels share one texture. Other clients show the finest level",
    "schema": {"enum": ["none", "msft"]}}
}
})json";

static constexpr ApiRoute kExportRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/export.{format}",
     .handler = export_model,
     .executor = Executor::kCompute,
     .doc =
         {.id = "exportModel",
          .summary = kSummary,
          .parameters =
              "triangles error bytes level kbps seconds saveData texture unit up compression lod",
          .response = kMediaTypes,
          .may_be_gzip = true}},
};

const ApiNoun kExports = {.routes = kExportRoutes, .components = kExportsComponents};

}  // namespace vitrine::server
