// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/levels.h"

#include <fmt/format.h>

#include <cstdlib>

namespace vitrine::server::cli {

std::string lattice_text(const Manifest& m) {
  return fmt::format("{} bits, step {:.6g} {}", m.lattice.bits, m.lattice.step,
                     m.unit.empty() ? "units" : m.unit);
}

nlohmann::json bytes_json(const Manifest& m) {
  return {{"total", m.file_bytes},        {"base", m.base_length},
          {"layers", m.chunk_bytes()},    {"header", m.base_offset},
          {"texture", m.texture.bytes()}, {"optional", m.optional_bytes()}};
}

nlohmann::json levels_json(const Manifest& m) {
  nlohmann::json levels = nlohmann::json::array();
  for (std::uint32_t l = 0; l < m.levels.size(); ++l) {
    levels.push_back({{"faces", m.levels[l].faces},
                      {"vertices", m.levels[l].vertices},
                      {"cumulative_bytes", m.cumulative_bytes(l)},
                      {"max_error", m.levels[l].max_error},
                      {"rms_error", m.levels[l].rms_error}});
  }
  return levels;
}

std::string levels_text(const Manifest& m) {
  std::string text = fmt::format("{:>5} {:>11} {:>11} {:>13} {:>12} {:>12}", "level", "faces",
                                 "vertices", "bytes so far", "max error", "rms error");
  for (std::uint32_t l = 0; l < m.levels.size(); ++l) {
    text += fmt::format("\n{:>5} {:>11} {:>11} {:>13} {:>12} {:>12.5g}", l, m.levels[l].faces,
                        m.levels[l].vertices, m.cumulative_bytes(l),
                        bound_text(m.levels[l].max_error), m.levels[l].rms_error);
  }
  return text;
}

}  // namespace vitrine::server::cli
