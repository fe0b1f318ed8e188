// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/described_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "codec/core/printable.h"
#include "codec/files/companions.h"
#include "codec/mesh/unit.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/reading.h"
#include "server/cli/support/sheet.h"
#include "server/metadata/fields.h"

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFile = "file", kUnit = "unit", kUp = "up";

std::vector<std::string_view> sheet_columns() {
  std::vector<std::string_view> columns = {kFile,     "title", "creator", "rights",
                                           "licence", kUnit,   kUp};
  columns.insert(columns.end(), std::begin(kMoreTexts), std::end(kMoreTexts));
  return columns;
}

std::string title_of(fs::path name) {
  if (name.extension() == ".gz") name.replace_extension();
  return as_utf8(name.stem().string());
}

// Returns the file with the texts and options that the flags give.
tl::expected<DescribedFile, Fault> by_flags(const Arguments& arguments, const std::string& in) {
  const auto reading = reading_options(arguments);
  if (!reading) return tl::unexpected(reading.error());
  auto model = ModelPath::of(in);
  if (!model) return failed(model.error());
  // Standard input can be read only once, and therefore not checked here.
  if (model->file != kStandardStream) {
    if (const auto file = InputFile::open(model->file); !file) return failed(file.error());
  }
  const ModelMetadata about = {.title = arguments.text("--title", title_of(model->file)),
                               .creator = arguments.text("--creator"),
                               .rights = arguments.text("--rights"),
                               .licence = arguments.text("--licence")};
  return DescribedFile{.model = std::move(*model),
                       .about = about,
                       .reading = *reading,
                       .states_reading = arguments.has("--unit") || arguments.has("--up")};
}

// Returns the path without "." and a slash at the end, so that one file has one name.
std::string normal(const std::string& path) {
  std::string name = fs::path(path).lexically_normal().string();
  if (name.size() > 1 && name.ends_with('/')) name.pop_back();
  return name;
}

class DescriptionSheet {
 public:
  DescriptionSheet(std::string name, std::vector<SheetRow> rows)
      : name_(std::move(name)), rows_(std::move(rows)) {
    for (const SheetRow& row : rows_)
      by_name_.emplace(normal(row.text(kFile)), &row);
  }

  // Appends the file `in` to `files`. If `in` is a folder that no row names, appends the files of
  // all rows, which are in that folder.
  CommandOutcome add(const Arguments& arguments, const std::string& in,
                     std::vector<DescribedFile>& files) {
    if (const SheetRow* row = row_of(in)) return add_row(arguments, *row, in, files);
    if (!fs::is_directory(in)) {
      return failed(fmt::format("{} has no row for {}; add one with this name in the column {}",
                                name_, in_quotes(in), kFile));
    }
    for (const SheetRow& row : rows_) {
      const fs::path path = fs::path(in) / row.text(kFile);
      if (!fs::exists(path))
        return fault(row, fmt::format("there is no {}", in_quotes(path.string())));
      if (auto added = add_row(arguments, row, path.string(), files); !added) return added;
    }
    return {};
  }

  void note_unused() const {
    std::vector<std::string> unused;
    for (const SheetRow& row : rows_)
      if (!used_.contains(row.line)) unused.push_back(row.text(kFile));
    if (unused.empty()) return;
    print_note(fmt::format("{}: rows for other files: {}, first {}", name_, unused.size(),
                           in_quotes(unused.front())));
  }

 private:
  // Returns the row of the file `in`, or null if there is none. The row names the whole path or the
  // end of the path. If several rows do, returns the one with the longest name.
  const SheetRow* row_of(const std::string& in) const {
    const std::string whole = normal(in);
    for (std::string_view path = whole;;) {
      if (const auto found = by_name_.find(path); found != by_name_.end()) return found->second;
      const std::size_t slash = path.find('/');
      if (slash == path.npos) return nullptr;
      path.remove_prefix(slash + 1);
    }
  }

  CommandOutcome add_row(const Arguments& arguments, const SheetRow& row, const std::string& in,
                         std::vector<DescribedFile>& files) {
    auto file = by_flags(arguments, in);
    if (!file) return tl::unexpected(file.error());
    if (auto described = describe(row, *file); !described) return described;
    if (!used_.insert(row.line).second)
      return fault(row, "two files have this name; write more of their paths in the sheet");
    files.push_back(std::move(*file));
    return {};
  }

  // Overrides the texts and options from the flags with those of the row. Columns that are empty in
  // the row change nothing.
  CommandOutcome describe(const SheetRow& row, DescribedFile& file) const {
    for (const auto& [column, text] : row.texts) {
      if (column == kUnit) {
        const auto unit = std::ranges::find(kLengthUnits, text, &LengthUnit::name);
        if (unit == kLengthUnits.end())
          return fault(row, "unit is not mm, cm, m or in; correct it");
        file.reading.unit = unit->name;
      } else if (column == kUp) {
        if (text != "y" && text != "z") return fault(row, "up is not y or z; correct it");
        file.reading.up = text == "z" ? UpAxis::kZ : UpAxis::kY;
      } else if (column != kFile) {
        text_of(file.about, column) = text;
      }
      file.states_reading = file.states_reading || column == kUnit || column == kUp;
    }
    const auto usable = check_texts(file.about);
    return usable ? CommandOutcome() : fault(row, usable.error().message);
  }

  static std::string& text_of(ModelMetadata& about, const std::string& column) {
    if (column == "title") return about.title;
    if (column == "creator") return about.creator;
    if (column == "rights") return about.rights;
    if (column == "licence") return about.licence;
    return about.more[column];
  }

  tl::unexpected<Fault> fault(const SheetRow& row, std::string_view text) const {
    return failed(fmt::format("{}, line {}: {}", name_, row.line, text));
  }

  const std::string name_;
  const std::vector<SheetRow> rows_;
  std::map<std::string, const SheetRow*, std::less<>> by_name_;
  std::set<std::size_t> used_;  // lines of the rows whose files are published
};

tl::expected<std::vector<DescribedFile>, Fault> described_by_sheet(const Arguments& arguments) {
  const std::string path = arguments.text("--metadata");
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  const std::string_view csv(reinterpret_cast<const char*>(file->bytes().data()),
                             file->bytes().size());
  auto rows = read_sheet(csv, path, sheet_columns());
  if (!rows) return failed(rows.error());
  DescriptionSheet sheet(path, std::move(*rows));
  std::vector<DescribedFile> files;
  for (const std::string& in : arguments.operands())
    if (auto added = sheet.add(arguments, in, files); !added) return tl::unexpected(added.error());
  if (files.empty())
    return failed(fmt::format("{} has no rows below its first line; add one for each file", path));
  sheet.note_unused();
  return files;
}

}  // namespace

tl::expected<std::vector<DescribedFile>, Fault> described_files(const Arguments& arguments) {
  if (arguments.has("--metadata")) {
    if (arguments.has("--title"))
      return misused("--title and --metadata exclude each other; give one");
    return described_by_sheet(arguments);
  }
  if (arguments.operands().size() > 1 && arguments.has("--title"))
    return misused("--title applies to one file; give the titles in a sheet with --metadata");
  std::vector<DescribedFile> files;
  for (const std::string& in : arguments.operands()) {
    auto file = by_flags(arguments, in);
    if (!file) return tl::unexpected(file.error());
    if (const auto usable = check_texts(file->about); !usable) return failed(usable.error());
    files.push_back(std::move(*file));
  }
  return files;
}

}  // namespace vitrine::server::cli
