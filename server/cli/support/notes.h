// SPDX-License-Identifier: Apache-2.0
// Joins the notes of a command's report.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace vitrine::server::cli {

// Joins the notes that are not empty.
inline std::string join_notes(std::vector<std::string> notes, std::string_view separator) {
  std::erase(notes, "");
  return fmt::format("{}", fmt::join(notes, separator));
}

}  // namespace vitrine::server::cli
