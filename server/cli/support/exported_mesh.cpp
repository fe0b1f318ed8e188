// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/exported_mesh.h"

#include <fmt/format.h>

#include <filesystem>

#include "codec/build/coarser_levels.h"
#include "codec/build/exported_texture.h"
#include "codec/build/originals.h"
#include "codec/build/refine.h"
#include "codec/export/zip.h"
#include "codec/files/atomic_file.h"
#include "server/cli/support/notes.h"
#include "server/cli/support/output.h"

namespace vitrine::server::cli {
namespace {

// Returns a note on the pictures that the format cannot hold, or an empty string.
std::string note_on_pictures(const Manifest& manifest, MeshFormat format) {
  PictureRoles lacking;
  for (const PictureInfo& picture : manifest.texture.pictures)
    lacking.set(static_cast<std::size_t>(picture.role));
  lacking &= ~roles_in(format);
  std::string names;
  for (std::uint8_t role = 0; role < kPictureRoles; ++role) {
    if (lacking.test(role))
      names += (names.empty() ? "" : ", ") + std::string(name_of(static_cast<PictureRole>(role)));
  }
  if (names.empty()) return {};
  return fmt::format("pictures that {} cannot hold are left out: {}; write GLB, which holds them",
                     row_of(format).name, names);
}

// Whether an export whose file name has this stem may have a companion file of this name.
bool is_companion(std::string_view name, const std::string& stem) {
  if (name == stem + ".mtl") return true;
  for (std::uint8_t role = 0; role < kPictureRoles; ++role) {
    const std::string picture = fmt::format("{}_{}", stem, name_of(static_cast<PictureRole>(role)));
    if (name == picture + ".jpg" || name == picture + ".png") return true;
  }
  return false;
}

// Decodes the coarser levels that an export contains besides the mesh that `refiner` shows.
Expected<std::vector<CoarserLevel>> levels_below(const Refiner& refiner,
                                                 std::span<const std::uint8_t> pmesh,
                                                 bool is_textured) {
  auto coarse = open_model(pmesh);
  if (!coarse) return tl::unexpected(coarse.error());
  const Manifest& manifest = refiner.manifest();
  const auto levels = coarser_levels(manifest, shown_detail(refiner).level, refiner.face_count());
  return decode_levels(std::move(*coarse), levels, is_textured, chunks_of(manifest, pmesh));
}

ExportOptions options_for(const Refiner& refiner, MeshFormat format, const ExportChoices& choices) {
  const ShownDetail detail = shown_detail(refiner);
  FileDescription about{.level = detail.level, .error = detail.error};
  return export_options(choices, format, refiner.manifest().unit, std::move(about),
                        {detail.grid_origin, detail.grid_step});
}

}  // namespace

tl::expected<ExportChoices, Fault> read_export_choices(const Arguments& arguments,
                                                       MeshFormat format) {
  const std::string unit = arguments.text("--unit"), up = arguments.text("--up"),
                    compression = arguments.text("--compression"), lod = arguments.text("--lod");
  ChoiceTexts texts;
  if (arguments.has("--unit")) texts.unit = unit;
  if (arguments.has("--up")) texts.up = up;
  if (arguments.has("--compression")) texts.compression = compression;
  if (arguments.has("--lod")) texts.lod = lod;
  const auto choices = read_choices(texts, format);
  if (choices) return *choices;
  return arguments.wrong_value(fmt::format("--{}", choices.error().name), choices.error().wanted);
}

tl::expected<std::optional<std::uint32_t>, Fault> read_texture_side(const Arguments& arguments) {
  const auto side = arguments.number(kTextureFlag.name, 0, kMaxPictureSide);
  if (!side) return tl::unexpected(side.error());
  return *side ? std::optional(static_cast<std::uint32_t>(**side)) : std::nullopt;
}

tl::expected<ExportKind, Fault> read_export_kind(const std::string& out, std::string_view others) {
  if (const auto kind = export_kind_of(out)) return *kind;
  return misused(fmt::format("cannot tell the output format from its name; use one of {}, {}{}",
                             std::string_view(kExportSuffixes), std::string_view(kZipSuffixes),
                             others));
}

tl::expected<std::string, Fault> name_of_output(const Arguments& arguments,
                                                std::string_view other) {
  if (!arguments.has("-o")) return misused("-o is missing; name the output file");
  const std::string out = arguments.text("-o"), format = arguments.text(kOutputFormat);
  if (out != kStandardStream) {
    if (format.empty()) return out;
    return misused(
        "--format needs -o -; leave it out, because the name of the output chooses the format");
  }
  const bool is_other = !other.empty() && format == other;
  if (is_other || export_kind_of("mesh." + format)) return "mesh." + format;
  return arguments.wrong_value(
      kOutputFormat,
      fmt::format("{}, or {}{}{}", std::string_view(kExportExtensions),
                  std::string_view(kZipExtensions), other.empty() ? "" : ", ", other));
}

Expected<Product> exported_mesh(const Refiner& refiner, std::span<const std::uint8_t> pmesh,
                                ExportKind kind, const std::string& out,
                                std::span<const std::size_t> pictures, const ExportChoices& choices,
                                const PresentationTransform& placement) {
  const Manifest& manifest = refiner.manifest();
  if (auto ok = check_unit(choices, manifest.unit); !ok) return tl::unexpected(ok.error());
  auto texturing = texturing_to_export(
      refiner, pictures, [&](std::size_t i) { return picture_of(manifest, pmesh, i); });
  if (!texturing) return tl::unexpected(texturing.error());
  TriangleMesh mesh = refiner.display_mesh();
  place(mesh, placement);
  Expected<std::vector<CoarserLevel>> coarser;
  if (choices.has_levels) coarser = levels_below(refiner, pmesh, !texturing->empty());
  if (!coarser) return tl::unexpected(coarser.error());
  for (CoarserLevel& level : *coarser)
    place(level, placement);
  ExportOptions options = options_for(refiner, kind.format, choices);
  options.about.error = *options.about.error * placement.scale();
  options.grid = placed(*options.grid, placement);
  options.coarser = *coarser;
  auto files =
      write_textured_mesh(mesh, *std::move(texturing), kind.format, stem_of_export(out), options);
  if (!files) return tl::unexpected(files.error());
  Product product{.report = {{"faces", mesh.faces.size()},
                             {"vertices", mesh.positions.size()},
                             {"pictures", pictures.size()}},
                  .file = {}};
  const std::string note = join_notes(
      {note_on_unknown_unit(kind.format, manifest.unit), note_on_precision(mesh, kind.format),
       pictures.empty() ? std::string() : note_on_pictures(manifest, kind.format)},
      "\n");
  if (!note.empty()) product.report["note"] = note;
  if (kind.is_zip) {
    auto packed = zip(*files);
    if (!packed) return tl::unexpected(packed.error());
    product.file = *std::move(packed);
  } else {
    product.file = std::move(files->front().bytes);
    product.companions.assign(std::make_move_iterator(files->begin() + 1),
                              std::make_move_iterator(files->end()));
  }
  return product;
}

Expected<Product> exported_originals(const Refiner& refiner, std::span<const std::uint8_t> pmesh,
                                     const std::string& out) {
  auto texturing = originals_of(refiner, pmesh);
  if (!texturing) return tl::unexpected(texturing.error());
  const TriangleMesh mesh = refiner.display_mesh();
  const std::size_t pictures = texturing->pictures.size();
  // glTF numbers the sets of texture coordinates consecutively. If only the second set is used, the
  // first set is filled with zeros.
  if (texturing->coordinates[0].empty()) texturing->coordinates[0].resize(mesh.faces.size());
  auto files = write_textured_mesh(mesh, *std::move(texturing), MeshFormat::kGlb,
                                   stem_of_export(out), options_for(refiner, MeshFormat::kGlb, {}));
  if (!files) return tl::unexpected(files.error());
  Product product{.report = {{"faces", mesh.faces.size()},
                             {"vertices", mesh.positions.size()},
                             {"pictures", pictures}},
                  .file = std::move(files->front().bytes)};
  const std::string note = note_on_unknown_unit(MeshFormat::kGlb, refiner.manifest().unit);
  if (!note.empty()) product.report["note"] = note;
  return product;
}

Expected<void> write_export(const Arguments& arguments, const std::string& out, Product& product) {
  const std::string stem = plain_name(stem_of_export(out));
  auto names = nlohmann::json::array();
  for (const MeshFile& companion : product.companions) {
    if (!is_companion(companion.name, stem))
      return fail(ErrorCode::kBadInput, out +
                                            " cannot have the companion that the isolated process "
                                            "returned; check the input with vitrine verify");
    const auto path = std::filesystem::path(out).replace_filename(companion.name);
    if (auto free = check_output(arguments, path); !free) return free;
    names.push_back(companion.name);
  }
  // Writes the mesh file last, so that an existing mesh file never names a companion that is
  // missing.
  for (const MeshFile& companion : product.companions) {
    const auto path = std::filesystem::path(out).replace_filename(companion.name);
    if (auto ok = write_file_atomically(path, companion.bytes); !ok) return ok;
  }
  product.report["companions"] = std::move(names);
  return write_file_atomically(out, product.file);
}

CommandOutcome write_export_or_stdout(const Arguments& arguments, Product& product) {
  const std::string out = arguments.text("-o");
  if (out != kStandardStream) {
    if (auto written = write_export(arguments, out, product); !written)
      return failed(written.error());
    return {};
  }
  if (product.companions.empty()) return write_output(out, product.file);
  return failed(
      "the pictures of this mesh are files of their own, which standard output cannot hold; use "
      "--format glb, a zip, or --texture 0");
}

std::string companions_as_text(const nlohmann::json& report) {
  std::string text;
  if (!report.contains("companions")) return text;
  for (const auto& name : report["companions"])
    text += (text.empty() ? ", with " : ", ") + name.get<std::string>();
  return text;
}

}  // namespace vitrine::server::cli
