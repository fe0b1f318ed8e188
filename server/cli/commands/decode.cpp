// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "codec/build/exported_texture.h"
#include "codec/build/open_model.h"
#include "codec/build/originals.h"
#include "codec/export/write_mesh.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/exported_mesh.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/output.h"
#include "server/cli/support/wants.h"

namespace vitrine::server::cli {
namespace {

// Returns the total size in bytes of the file's head and all applied chunks.
std::uint64_t bytes_used(const Refiner& refiner) {
  std::uint64_t bytes = refiner.manifest().head_bytes();
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.is_applied(i)) bytes += refiner.manifest().chunks[i].length;
  }
  return bytes;
}

struct Export {
  std::string out;
  ExportKind kind;
  std::optional<std::uint32_t> texture_side;  // largest width of the pictures, in pixels
  ExportChoices choices;
  bool has_originals;  // whether to write the originals instead of the display atlas
};

Expected<Product> decode_to(std::span<const std::uint8_t> pmesh, const std::optional<Want>& wanted,
                            const Export& target, const ProgressReport& progress) {
  auto refiner = open_model(pmesh);
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  const Want want =
      wanted.value_or(WantLevel{static_cast<std::uint32_t>(manifest.levels.size() - 1)});
  if (auto ok = check_want(manifest, want); !ok) return tl::unexpected(ok.error());

  const ChunkReader chunks = chunks_of(manifest, pmesh);
  const auto reader = [&](std::size_t chunk) {
    progress("decode", static_cast<double>(chunk) / static_cast<double>(manifest.chunks.size()));
    return chunks(chunk);
  };
  if (auto ok = refine(*refiner, want, reader); !ok) return tl::unexpected(ok.error());
  if (target.has_originals) {
    auto product = exported_originals(*refiner, pmesh, target.out);
    if (product) product->report["bytes"] = bytes_used(*refiner) + originals_bytes(manifest);
    return product;
  }
  const auto pictures = pictures_to_export(manifest, refiner->face_count(), target.texture_side,
                                           roles_in(target.kind.format));
  auto product = exported_mesh(*refiner, pmesh, target.kind, target.out, pictures, target.choices);
  if (product) product->report["bytes"] = bytes_used(*refiner);
  return product;
}

// Checks that --originals, if given, fits the output's format and the other flags. The originals
// are the source's own materials, texture coordinates and pictures (codec/build/originals.h).
tl::expected<void, Fault> check_originals(const Arguments& arguments, ExportKind kind,
                                          const std::optional<Want>& want) {
  if (!arguments.has("--originals")) return {};
  if (kind.format != MeshFormat::kGlb || kind.is_zip)
    return misused("only .glb holds the originals; name such an output file");
  if (arguments.has(kCompressionFlag.name))
    return misused("the originals are kept to the bit; leave out --compression");
  if (arguments.has(kLodFlag.name))
    return misused("only the finest level has originals; leave out --lod");
  if (want || arguments.has(kTextureFlag.name)) {
    return misused(
        "the originals belong to the finest level; leave out --level, --triangles, --bytes, "
        "--error and --texture");
  }
  return {};
}

CommandOutcome decode(const Arguments& arguments) {
  const auto name = name_of_output(arguments);
  if (!name) return tl::unexpected(name.error());
  const std::string out = arguments.text("-o");
  const auto kind = read_export_kind(*name);
  if (!kind) return tl::unexpected(kind.error());
  const auto want = read_want(arguments);
  if (!want) return tl::unexpected(want.error());
  const auto texture_side = read_texture_side(arguments);
  if (!texture_side) return tl::unexpected(texture_side.error());
  const auto choices = read_export_choices(arguments, kind->format);
  if (!choices) return tl::unexpected(choices.error());
  if (const auto fits = check_originals(arguments, *kind, *want); !fits)
    return tl::unexpected(fits.error());
  if (const auto distinct = check_distinct(arguments.operand(0), out); !distinct)
    return failed(distinct.error());
  if (const auto free = check_output_or_stdout(arguments, out); !free) return failed(free.error());
  const std::string path = arguments.operand(0);
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());

  auto product = isolate(path, [&](const ProgressReport& progress) {
    return decode_to(file->bytes(), *want,
                     {.out = *name,
                      .kind = *kind,
                      .texture_side = *texture_side,
                      .choices = *choices,
                      .has_originals = arguments.has("--originals")},
                     progress);
  });
  if (!product) return tl::unexpected(product.error());
  if (auto written = write_export_or_stdout(arguments, *product); !written) return written;
  const auto& report = product->report;
  if (arguments.has("--json")) return print_json(report, result_stream(out));
  return print(
      fmt::format("{}: {} faces, {} vertices from {} bytes{}", out,
                  report["faces"].get<std::uint64_t>(), report["vertices"].get<std::uint64_t>(),
                  report["bytes"].get<std::uint64_t>(), companions_as_text(report)),
      result_stream(out));
}

constexpr std::string_view kDecodeOperands[] = {"FILE.pmesh"};
constexpr FixedText kDecodeOutput = concatenate("OUT.{", kExportChoice, "}");
constexpr FixedText kDecodeFormats =
    concatenate(join(kExportFormats, extension_of, "|", "|"), "|", kZipChoice);
constexpr FixedText kDecodeDetails = concatenate(
    "The name of OUT chooses the format. FILE.pmesh may be -, which is standard input. With -o -, "
    "which is standard output, --format chooses the format, and the summary goes to standard "
    "error. --level, --triangles, --bytes and --error exclude each other; without any, the finest "
    "level is written. ",
    kNoteOnCompanions);
constexpr Flag kDecodeFlags[] = {
    {"-o", kDecodeOutput, "mesh file to write (required); - is standard output"},
    {kOutputFormat, kDecodeFormats, kOutputFormatHelp},
    {"--level", "L", "level of detail; 0 is the coarsest; vitrine info lists the levels"},
    {"--triangles", "N", "finest mesh with at most N triangles"},
    {"--bytes", "B", "finest mesh in the first B bytes of the file"},
    {"--error", "E", "coarsest level within E of the original, in the model's unit"},
    kTextureFlag,
    kUnitInFileFlag,
    kUpInFileFlag,
    kCompressionFlag,
    kLodFlag,
    {"--originals", "",
     "write the source's own materials, pictures and texture coordinates, unchanged, instead of "
     "the model's; only for .glb"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kDecode = {.name = "decode",
                         .summary = "Writes the mesh of a .pmesh file, at full or reduced detail.",
                         .details = kDecodeDetails,
                         .operands = kDecodeOperands,
                         .flags = kDecodeFlags,
                         .examples =
                             "vitrine decode bust.pmesh -o bust.glb\nvitrine decode bust.pmesh -o "
                             "small.ply --triangles 20000",
                         .run = decode};

}  // namespace vitrine::server::cli
