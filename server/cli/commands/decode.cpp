// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "codec/build/open_model.h"
#include "codec/export/write_mesh.h"
#include "codec/files/atomic_file.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/wants.h"

namespace vitrine::server::cli {
namespace {

nlohmann::json describe(const Refiner& refiner, const TriangleMesh& mesh) {
  std::uint64_t bytes = refiner.manifest().head_bytes();
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.is_applied(i)) bytes += refiner.manifest().chunks[i].length;
  }
  return {{"faces", mesh.faces.size()}, {"vertices", mesh.positions.size()}, {"bytes", bytes}};
}

Expected<Product> decode_to(std::span<const std::uint8_t> pmesh, const std::optional<Want>& wanted,
                            MeshFormat format, const ProgressReport& progress) {
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
  const TriangleMesh mesh = refiner->display_mesh();
  auto file = write_mesh(mesh, format, manifest.unit);
  if (!file) return tl::unexpected(file.error());
  nlohmann::json report = describe(*refiner, mesh);
  if (auto note = note_on_precision(mesh, format); !note.empty()) report["note"] = note;
  return Product{std::move(report), std::move(*file)};
}

CommandOutcome decode(const Arguments& arguments) {
  if (!arguments.has("-o")) return misused("-o is missing; name the output file");
  const std::string out = arguments.text("-o");
  const auto format = format_of_extension(std::filesystem::path(out).extension().string());
  if (!format)
    return misused(fmt::format("cannot tell the output format from its name; use one of {}",
                               std::string_view(kExportSuffixes)));
  const auto want = read_want(arguments);
  if (!want) return tl::unexpected(want.error());
  if (const auto writable = check_writable(out); !writable) return failed(writable.error());
  if (const auto distinct = check_distinct(arguments.operand(0), out); !distinct)
    return failed(distinct.error());
  const std::string path = arguments.operand(0);
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());

  const auto product = isolate(path, [&](const ProgressReport& progress) {
    return decode_to(file->bytes(), *want, *format, progress);
  });
  if (!product) return tl::unexpected(product.error());
  if (auto written = write_file_atomically(out, product->file); !written) {
    return failed(written.error());
  }
  const auto& report = product->report;
  if (arguments.has("--json")) return print_json(report);
  return print(fmt::format(
      "{}: {} faces, {} vertices from {} bytes", out, report["faces"].get<std::uint64_t>(),
      report["vertices"].get<std::uint64_t>(), report["bytes"].get<std::uint64_t>()));
}

constexpr std::string_view kDecodeOperands[] = {"FILE.pmesh"};
constexpr FixedText kDecodeOutput = concatenate("OUT.{", kExportChoice, "}");
constexpr Flag kDecodeFlags[] = {
    {"-o", kDecodeOutput, "mesh, in the model's unit; .glb, .wrl in metres (required)"},
    {"--level", "L", "level of detail; 0 is the coarsest"},
    {"--triangles", "N", "finest mesh with at most N triangles"},
    {"--bytes", "B", "finest mesh in the first B bytes of the file"},
    {"--error", "E", "coarsest level within E of the original, in the model's unit"},
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kDecode = {
    .name = "decode",
    .summary = "Writes the mesh of a .pmesh file, at full or reduced detail.",
    .details =
        "The name of OUT chooses the format. --level, --triangles, --bytes and "
        "--error exclude each other; without any, the finest level is written.",
    .operands = kDecodeOperands,
    .flags = kDecodeFlags,
    .run = decode};

}  // namespace vitrine::server::cli
