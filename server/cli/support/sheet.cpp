// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "codec/core/printable.h"
#include "server/config/help_text.h"

namespace vitrine::server::cli {
namespace {

using Cells = std::vector<std::string>;

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf", kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return 'A' <= c && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return lower;
}

// Returns the separator that occurs most often in the header, a comma if none occurs.
char separator_of(std::string_view csv) {
  const std::string_view header = csv.substr(0, csv.find_first_of("\r\n"));
  const auto count = [&](char c) { return std::ranges::count(header, c); };
  return std::max({',', ';', '\t'}, [&](char a, char b) { return count(a) < count(b); });
}

// Reads one row after the other.
class CsvReader {
 public:
  CsvReader(std::string_view csv, char separator) : rest_(csv), separator_(separator) {}

  bool is_at_end() const { return rest_.empty(); }
  std::size_t line() const { return line_; }  // line of the next row, from 1

  // Returns the next row's cells, or nullopt if the file ends within a quoted cell.
  std::optional<Cells> row() {
    Cells cells;
    for (;;) {
      skip_blanks();
      auto cell = starts_with('"') ? quoted() : plain();
      if (!cell) return std::nullopt;
      cells.push_back(std::move(*cell));
      if (!skip(separator_)) break;
    }
    const bool has_return = skip('\r');
    if (skip('\n') || has_return) ++line_;
    return cells;
  }

 private:
  bool starts_with(char c) const { return !rest_.empty() && rest_.front() == c; }
  bool skip(char c) {
    if (!starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void skip_blanks() {
    while (skip(' ') || (separator_ != '\t' && skip('\t'))) {
    }
  }
  std::string take(std::size_t length) {
    std::string text(rest_.substr(0, length));
    rest_.remove_prefix(text.size());
    return text;
  }
  std::string plain() {
    const char ends[] = {separator_, '\r', '\n'};
    return std::string(trimmed(take(rest_.find_first_of(std::string_view(ends, std::size(ends))))));
  }
  // Two quotation marks in a quoted cell stand for one. Text after the closing quotation mark,
  // which some programs write, belongs to the cell.
  std::optional<std::string> quoted() {
    std::string cell;
    for (bool is_first = true; skip('"'); is_first = false) {
      if (!is_first) cell += '"';
      const std::size_t end = rest_.find('"');
      if (end == rest_.npos) return std::nullopt;
      cell += take(end);
      skip('"');
    }
    line_ += static_cast<std::size_t>(std::ranges::count(cell, '\n'));
    std::erase(cell, '\r');
    return cell + plain();
  }

  std::string_view rest_;
  const char separator_;
  std::size_t line_ = 1;
};

// Checks the rows of one sheet and assigns each cell to its column.
class SheetReader {
 public:
  SheetReader(std::string_view name, std::span<const std::string_view> columns)
      : name_(name), columns_(columns) {}

  Expected<void> read_header(const Cells& cells) {
    for (const std::string& cell : cells) {
      const std::string column = lower_case(trimmed(cell));
      if (!column.empty() && std::ranges::find(columns_, column) == columns_.end())
        return unknown_column(cell);
      if (!column.empty() && std::ranges::find(header_, column) != header_.end())
        return fault(1, fmt::format("two columns are named {}; leave out one", column));
      header_.push_back(column);
    }
    if (std::ranges::find(header_, columns_[0]) != header_.end()) return {};
    return fault(
        1, fmt::format("no column is named {}; name the columns in the first line", columns_[0]));
  }

  Expected<SheetRow> read_row(std::size_t line, Cells cells) {
    SheetRow row{.line = line};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].empty()) continue;
      if (i >= header_.size() || header_[i].empty()) return beyond_header(line, i);
      row.texts.emplace(header_[i], std::move(cells[i]));
    }
    if (row.texts.empty()) return row;
    const std::string key = row.text(columns_[0]);
    if (key.empty()) return fault(line, fmt::format("{} is missing; add it", columns_[0]));
    if (!keys_.insert(key).second)
      return fault(line, fmt::format("{} {} has two rows; leave out one", columns_[0], key));
    return row;
  }

  Unexpected fault(std::size_t line, std::string_view text) const {
    return fail(ErrorCode::kBadInput, fmt::format("{}, line {}: {}", name_, line, text));
  }

 private:
  Unexpected unknown_column(std::string_view cell) const {
    const std::string_view near = suggest(lower_case(trimmed(cell)), columns_);
    return fault(
        1, near.empty()
               ? fmt::format("no text is named \"{}\"; leave that column out, or name it as "
                             "one of {}",
                             trimmed(cell), fmt::join(columns_, ", "))
               : fmt::format("no text is named \"{}\"; did you mean {}?", trimmed(cell), near));
  }
  Unexpected beyond_header(std::size_t line, std::size_t column) const {
    return fault(line,
                 fmt::format("cell {} has a text, but its column has no name; name the column, "
                             "or put cells with separators in quotation marks",
                             column + 1));
  }

  const std::string_view name_;
  const std::span<const std::string_view> columns_;
  Cells header_;
  std::set<std::string> keys_;
};

}  // namespace

std::string SheetRow::text(std::string_view column) const {
  const auto found = texts.find(column);
  return found == texts.end() ? std::string() : found->second;
}

Expected<std::vector<SheetRow>> read_sheet(std::string_view csv, std::string_view name,
                                           std::span<const std::string_view> columns) {
  if (csv.size() > kMaxSheetBytes)
    return fail(ErrorCode::kLimit, fmt::format("{} is larger than 64 MiB; split it", name));
  if (csv.starts_with(kByteOrderMark)) csv.remove_prefix(kByteOrderMark.size());
  if (!is_utf8(csv))
    return fail(ErrorCode::kBadInput, fmt::format("{} is not UTF-8; save it as CSV UTF-8", name));
  CsvReader reader(csv, separator_of(csv));
  SheetReader sheet(name, columns);
  std::vector<SheetRow> rows;
  for (bool is_header = true; is_header || !reader.is_at_end(); is_header = false) {
    const std::size_t line = reader.line();
    auto cells = reader.row();
    if (!cells) return sheet.fault(line, "a quotation mark is not closed; close it");
    if (is_header) {
      if (auto header = sheet.read_header(*cells); !header) return tl::unexpected(header.error());
      continue;
    }
    auto row = sheet.read_row(line, std::move(*cells));
    if (!row) return tl::unexpected(row.error());
    if (row->texts.empty()) continue;
    if (rows.size() == kMaxSheetRows)
      return fail(ErrorCode::kLimit,
                  fmt::format("{} has more than {} rows; split it", name, kMaxSheetRows));
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace vitrine::server::cli
