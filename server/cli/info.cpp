// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/input.h"
#include "server/cli/levels.h"

namespace vitrine::cli {
namespace {

using nlohmann::json;

json describe(const Manifest& m) {
  return {{"bits", m.lattice.bits},
          {"step", m.lattice.step},
          {"origin", {m.lattice.origin.x, m.lattice.origin.y, m.lattice.origin.z}},
          {"unit", m.unit},
          {"placement", m.placement == Placement::kPyramid ? "pyramid" : "midpoint"},
          {"coloured", m.coloured},
          {"boundary_loops", m.loops},
          {"regions", m.tree.leaves()},
          {"chunks", m.chunks.size()},
          {"bytes", bytes_json(m)},
          {"levels", levels_json(m)}};
}

std::string as_text(const json& info, const Manifest& m) {
  return fmt::format(
      "{} bytes: header {}, base mesh {}, {} chunks {}\n"
      "{} bits, step {:.6g} {}, {} placement, {} region(s), {} boundary loop(s){}\n\n{}",
      m.file_bytes, m.base_offset, m.base_length, m.chunks.size(),
      info["bytes"]["layers"].get<std::uint64_t>(), m.lattice.bits, m.lattice.step,
      m.unit.empty() ? "units" : m.unit, info["placement"].get<std::string>(), m.tree.leaves(),
      m.loops, m.coloured ? ", coloured" : "", levels_text(m));
}

Outcome info(const Arguments& arguments) {
  const std::string path = arguments.operand(0);
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  const auto manifest = parse_header(file->bytes());
  if (!manifest) return failed(fmt::format("{}: {}", path, manifest.error().message));
  const json report = describe(*manifest);
  return arguments.has("--json") ? print_json(report) : print(as_text(report, *manifest));
}

constexpr std::string_view kOperands[] = {"FILE.pmesh"};
constexpr Flag kFlags[] = {{"--json", "", "print one JSON object"}};

}  // namespace

const Command kInfo = {"info", "Prints a .pmesh file's header and levels.", kOperands, kFlags,
                       info};

}  // namespace vitrine::cli
