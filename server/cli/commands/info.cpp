// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
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

json describe(const Manifest& m) {
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
          {"levels", levels_json(m)}};
}

std::string as_text(const json& info, const Manifest& m) {
  const std::string insertions =
      m.has_insertions ? fmt::format(", {} vertices in component insertions", inserted_vertices(m))
                       : std::string();
  return fmt::format(
      "{} bytes: header {}, base mesh {}, {} chunks {}\n"
      "{}, {} placement, {} region(s), {} boundary loop(s){}{}\n\n{}",
      m.file_bytes, m.base_offset, m.base_length, m.chunks.size(),
      info["bytes"]["layers"].get<std::uint64_t>(), lattice_text(m),
      info["placement"].get<std::string>(), m.tree.leaves(), m.loops, insertions,
      m.has(Semantic::kColour) ? ", coloured" : "", levels_text(m));
}

// Describes how much of a truncated file is present. Such a file is a coarser model. Returns an
// empty text for a complete file.
std::string what_is_here(const Manifest& m, std::uint64_t here) {
  if (here >= m.file_bytes) return "";
  if (here < m.head_bytes())
    return fmt::format("cut off at byte {}: the base mesh is incomplete\n", here);
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
  const json report = describe(*manifest);
  if (arguments.has("--json")) return print_json(report);
  return print(what_is_here(*manifest, file->bytes().size()) + as_text(report, *manifest));
}

constexpr std::string_view kInfoOperands[] = {"FILE.pmesh"};
constexpr Flag kInfoFlags[] = {{"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kInfo = {.name = "info",
                       .summary = "Prints the header and the levels of a .pmesh file.",
                       .operands = kInfoOperands,
                       .flags = kInfoFlags,
                       .run = info};

}  // namespace vitrine::server::cli
