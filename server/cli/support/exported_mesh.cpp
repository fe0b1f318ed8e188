// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/exported_mesh.h"

#include <fmt/format.h>

#include <filesystem>

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

// Whether an export with this stem may have a companion of this name.
bool is_companion(std::string_view name, const std::string& stem) {
  if (name == stem + ".mtl") return true;
  for (std::uint8_t role = 0; role < kPictureRoles; ++role) {
    const std::string picture = fmt::format("{}_{}", stem, name_of(static_cast<PictureRole>(role)));
    if (name == picture + ".jpg" || name == picture + ".png") return true;
  }
  return false;
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
                    compression = arguments.text("--compression");
  ChoiceTexts texts;
  if (arguments.has("--unit")) texts.unit = unit;
  if (arguments.has("--up")) texts.up = up;
  if (arguments.has("--compression")) texts.compression = compression;
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

Expected<Product> exported_mesh(const Refiner& refiner, std::span<const std::uint8_t> pmesh,
                                ExportKind kind, const std::string& out,
                                std::span<const std::size_t> pictures,
                                const ExportChoices& choices) {
  const Manifest& manifest = refiner.manifest();
  if (auto ok = check_unit(choices, manifest.unit); !ok) return tl::unexpected(ok.error());
  auto texturing = texturing_to_export(
      refiner, pictures, [&](std::size_t i) { return picture_of(manifest, pmesh, i); });
  if (!texturing) return tl::unexpected(texturing.error());
  const TriangleMesh mesh = refiner.display_mesh();
  auto files = write_textured_mesh(mesh, *std::move(texturing), kind.format, stem_of_export(out),
                                   options_for(refiner, kind.format, choices));
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
  // glTF numbers its sets consecutively. If only the second set is used, the first one is filled
  // with zeros.
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

std::string companions_as_text(const nlohmann::json& report) {
  std::string text;
  if (!report.contains("companions")) return text;
  for (const auto& name : report["companions"])
    text += (text.empty() ? ", with " : ", ") + name.get<std::string>();
  return text;
}

}  // namespace vitrine::server::cli
