// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/find_faults.h"

#include <fmt/core.h>

#include <algorithm>

#include "server/catalogue/sqlite.h"
#include "server/catalogue/sqlite_database.h"

namespace vitrine::server::sqlite {
namespace {

constexpr std::size_t kMostFaults = 20;

// Whether the connection's last error means that the file is damaged or that parts of it cannot be
// read. Returns false for other errors, for example if the file cannot be opened.
bool is_damage(const SqliteHandle& database) {
  const int code = sqlite3_errcode(database.handle());
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB || code == SQLITE_IOERR;
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

void add_structure_faults(const SqliteHandle& database, std::vector<std::string>& faults) {
  SqliteStatement row(database, fmt::format("PRAGMA integrity_check({})", kMostFaults));
  while (row.step()) {
    if (row.text(0) != "ok") faults.push_back(one_line(row.text(0)));
  }
}

// Compares the pages of the full-text index with each other, because PRAGMA integrity_check does
// not check these pages. Catalogues of older versions have no such index.
void add_index_faults(const SqliteHandle& database, std::vector<std::string>& faults) {
  if (!SqliteStatement(database, "SELECT 1 FROM sqlite_schema WHERE name = 'model_words'").any())
    return;
  SqliteStatement check(database, "INSERT INTO model_words(model_words) VALUES('integrity-check')");
  try {
    check.step();
  } catch (const sql::Failure&) {
    if (sqlite3_errcode(database.handle()) % 256 != SQLITE_CORRUPT) throw;
    faults.emplace_back("the full-text index is damaged");
  }
}

void add_reference_faults(const SqliteHandle& database, std::vector<std::string>& faults) {
  SqliteStatement row(database, "PRAGMA foreign_key_check");
  while (faults.size() < kMostFaults && row.step()) {
    faults.push_back(fmt::format("a row of the table {} refers to a row that is missing from {}",
                                 row.text(0), row.text(2)));
  }
}

// Returns the number of the newest migration, or nullopt if the record of migrations has gaps.
std::optional<std::int64_t> version_of(const SqliteHandle& database) {
  SqliteStatement row(database, "SELECT count(*), coalesce(max(version), 0) FROM migration");
  row.step();
  return row.integer(0) == row.integer(1) ? std::optional(row.integer(0)) : std::nullopt;
}

bool has_object(const SqliteHandle& database, const sql::Statement& wanted) {
  SqliteStatement row(database,
                      "SELECT 1 FROM sqlite_schema WHERE type = ? AND name = ? AND tbl_name = ? "
                      "AND sql = ?");
  for (int column = 0; column < 4; ++column)
    wanted.bind_to(row, column);
  return row.any();
}

// Compares the tables, indices and triggers with those that the migrations create. Skips databases
// of another version, because their schema differs.
void add_schema_faults(const SqliteHandle& database, std::vector<std::string>& faults) {
  SqliteStatement encoding(database, "PRAGMA encoding");
  if (!encoding.step() || encoding.text(0) != "UTF-8")
    faults.emplace_back("the encoding of texts is not UTF-8");
  const auto version = version_of(database);
  if (!version) faults.emplace_back("the record of migrations has gaps");
  const auto tables = newest_tables();
  const auto intact = tables->lease();
  const sql::ScopedStatement newest(intact->prepare("SELECT max(version) FROM migration"));
  newest->step();
  if (version != newest->integer(0)) return;
  const sql::ScopedStatement wanted(
      intact->prepare("SELECT type, name, tbl_name, sql FROM sqlite_schema WHERE sql IS NOT NULL"));
  while (wanted->step()) {
    if (!has_object(database, *wanted))
      faults.push_back(
          fmt::format("the {} {} is missing or changed", wanted->text(0), wanted->text(1)));
  }
}

}  // namespace

Expected<std::vector<std::string>> find_faults(const std::filesystem::path& file) {
  std::vector<std::string> faults;
  try {
    const SqliteHandle database(file.string());
    try {
      add_structure_faults(database, faults);
      if (faults.empty()) add_index_faults(database, faults);
      if (faults.empty()) add_reference_faults(database, faults);
      if (faults.empty()) add_schema_faults(database, faults);
    } catch (const sql::Failure& failure) {
      if (!is_damage(database)) throw;
      faults.emplace_back(failure.what());
    }
    return faults;
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot check the catalogue " + file.string(), failure);
  }
}

}  // namespace vitrine::server::sqlite
