// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "codec/build/charts.h"
#include "codec/build/open_model.h"
#include "codec/build/originals.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/levels.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;

std::uint64_t inserted_vertices(const Manifest& m) {
  std::uint64_t vertices = 0;
  for (const ChunkInfo& chunk : m.chunks)
    vertices += chunk.inserted;
  return vertices;
}

// Describes the texture. Returns null if the model has no texture. `charts` is the number of charts
// in the atlas, or null if the file ends before the atlas.
json texture_json(const Manifest& m, const json& charts) {
  if (m.texture.empty()) return nullptr;
  json pictures = json::array();
  for (std::uint32_t i = 0; i < m.texture.pictures.size(); ++i) {
    const PictureInfo& picture = m.texture.pictures[i];
    pictures.push_back({{"role", name_of(picture.role)},
                        {"side", picture.side},
                        {"bytes", picture.length},
                        {"in_head", i < m.texture.in_head}});
  }
  return {{"charts", charts},
          {"atlas_bytes", m.texture.atlas_length},
          {"pictures", pictures},
          {"originals_bytes", originals_bytes(m)}};
}

// Decodes the base mesh and its atlas in the sandbox, to count the charts. Returns null if the
// model has no texture, or if the file ends before the atlas.
tl::expected<json, Fault> count_charts(const std::string& path, const Manifest& m,
                                       std::span<const std::uint8_t> pmesh) {
  if (m.texture.empty() || pmesh.size() < m.texture.atlas_offset + m.texture.atlas_length)
    return json();
  const auto product = isolate(path, [&](const ProgressReport&) -> Expected<Product> {
    const auto refiner = open_model(pmesh);
    if (!refiner) return tl::unexpected(refiner.error());
    return Product{{{"charts", chart_count(*refiner)}}, {}};
  });
  if (!product) return tl::unexpected(product.error());
  return product->report["charts"];
}

json describe(const Manifest& m, const json& charts) {
  return {{"bits", m.lattice.bits},
          {"step", m.lattice.step},
          {"origin", {m.lattice.origin.x, m.lattice.origin.y, m.lattice.origin.z}},
          {"unit", m.unit},
          {"placement", m.placement == Placement::kPyramid ? "pyramid" : "midpoint"},
          {"coloured", m.has(Semantic::kColour)},
          {"boundary_loops", m.loops},
          {"born_whole", inserted_vertices(m)},
          {"regions", m.tree.leaves()},
          {"chunks", m.chunks.size()},
          {"bytes", bytes_json(m)},
          {"texture", texture_json(m, charts)},
          {"levels", levels_json(m)}};
}

// Returns a line for the atlas and a line for each picture.
std::string texture_text(const json& texture) {
  if (texture.is_null()) return "";
  const std::string charts =
      texture["charts"].is_null()
          ? std::string()
          : fmt::format(", {} chart(s)", texture["charts"].get<std::uint32_t>());
  std::string text = fmt::format("texture: atlas {} bytes{}\n",
                                 texture["atlas_bytes"].get<std::uint64_t>(), charts);
  for (const json& picture : texture["pictures"]) {
    const auto side = picture["side"].get<std::uint32_t>();
    text += fmt::format("  {:<12} {} x {}, {} bytes{}\n", picture["role"].get<std::string>(), side,
                        side, picture["bytes"].get<std::uint64_t>(),
                        picture["in_head"].get<bool>() ? ", in the head" : "");
  }
  const auto originals = texture["originals_bytes"].get<std::uint64_t>();
  if (originals > 0)
    text += fmt::format("  originals of the source: {} bytes, which no viewer loads\n", originals);
  return text + "\n";
}

std::string as_text(const json& info, const Manifest& m) {
  const std::string insertions =
      m.has_insertions ? fmt::format(", {} vertices in component insertions", inserted_vertices(m))
                       : std::string();
  return fmt::format(
      "{} bytes: header {}, base mesh {}, {} chunks {}\n"
      "{}, {} placement, {} region(s), {} boundary loop(s){}{}\n\n{}{}",
      m.file_bytes, m.base_offset, m.base_length, m.chunks.size(), m.chunk_bytes(), lattice_text(m),
      info["placement"].get<std::string>(), m.tree.leaves(), m.loops, insertions,
      m.has(Semantic::kColour) ? ", coloured" : "", texture_text(info["texture"]), levels_text(m));
}

// Describes how much of a truncated file is present. A truncated file is a valid, coarser model.
// Returns an empty text for a complete file.
std::string what_is_here(const Manifest& m, std::uint64_t here) {
  if (here >= m.file_bytes) return "";
  if (here < m.head_bytes())
    return fmt::format("cut off at byte {}: the head is incomplete\n", here);
  std::uint32_t level = 0;
  while (level + 1 < m.levels.size() && m.cumulative_bytes(level + 1) <= here)
    ++level;
  return fmt::format("cut off at byte {}: level {} and all coarser levels are complete\n", here,
                     level);
}

CommandOutcome info(const Arguments& arguments) {
  const std::string path = arguments.operand(0);
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  const auto manifest = parse_header(file->bytes());
  if (!manifest) return failed(fmt::format("{}: {}", path, manifest.error().message));
  const auto charts = count_charts(path, *manifest, file->bytes());
  if (!charts) return tl::unexpected(charts.error());
  const json report = describe(*manifest, *charts);
  if (arguments.has("--json")) return print_json(report);
  return print(what_is_here(*manifest, file->bytes().size()) + as_text(report, *manifest));
}

constexpr std::string_view kInfoOperands[] = {"FILE.pmesh"};
constexpr Flag kInfoFlags[] = {{"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kInfo = {.name = "info",
                       .summary = "Prints the header, the levels and the texture of a .pmesh file.",
                       .operands = kInfoOperands,
                       .flags = kInfoFlags,
                       .examples =
                           "vitrine info bust.pmesh\n"
                           "vitrine info bust.pmesh --json",
                       .run = info};

}  // namespace vitrine::server::cli
