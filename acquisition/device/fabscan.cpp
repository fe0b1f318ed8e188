// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/fabscan.h"

#include <fmt/format.h>

#include <cctype>

namespace vitrine::acquisition::fabscan {

std::string turn(int steps) {
  return fmt::format("G02 T{} F200", steps);
}

bool is_version(const std::string& line) {
  const std::size_t digits = line.starts_with("v.") ? 2 : line.starts_with("v") ? 1 : line.size();
  return digits < line.size() && std::isdigit(static_cast<unsigned char>(line[digits])) != 0;
}

}  // namespace vitrine::acquisition::fabscan
