// SPDX-License-Identifier: Apache-2.0
// Reads a spreadsheet of texts about model files, saved as CSV ([RFC4180]).
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server::cli {

inline constexpr std::size_t kMaxSheetBytes = std::size_t{64} << 20, kMaxSheetRows = 100'000;

struct SheetRow {
  std::size_t line = 0;  // line of the file at which the row begins, from 1
  std::map<std::string, std::string, std::less<>> texts;  // column -> text, without empty texts

  std::string text(std::string_view column) const;  // empty if the row has no such text
};

// Returns the rows below the header. The header names the columns, which must be among `columns`
// and include columns[0]. Case does not matter in these names. Rows without any text are left out;
// in every other row, columns[0] must have a text that no other row has. Cells are separated by
// commas, semicolons or tabs, whichever the header has most of. Line ends in cells become line
// feeds. Fails with kBadInput if the text is not UTF-8 or not such a sheet, and with kLimit beyond
// the limits above. Errors name `name`, the line and the next step.
Expected<std::vector<SheetRow>> read_sheet(std::string_view csv, std::string_view name,
                                           std::span<const std::string_view> columns);

}  // namespace vitrine::server::cli
