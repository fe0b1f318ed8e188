// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql.h"

#include <optional>

namespace vitrine::server::sql {

bool Statement::any() {
  bool found = false;
  while (step())
    found = true;
  return found;
}

namespace {

std::int64_t newest_version(DatabaseConnection& connection) {
  const ScopedStatement row(connection.prepare("SELECT coalesce(max(version), 0) FROM migration"));
  row->step();
  return row->integer(0);
}

void apply(DatabaseConnection& connection, std::span<const char* const> steps) {
  const auto wanted = static_cast<std::int64_t>(steps.size());
  for (std::int64_t version = newest_version(connection); version < wanted; ++version) {
    connection.run(steps[static_cast<std::size_t>(version)]);
    const ScopedStatement record(connection.prepare("INSERT INTO migration(version) VALUES (?)"));
    record->bind(version + 1).step();
  }
}

// Programs made for an older schema version may still be able to use a database of `version`.
// Returns the oldest such schema version, or nullopt if the database does not record it.
std::optional<std::int64_t> compatible_since(DatabaseConnection& connection, std::int64_t version) {
  const ScopedStatement row(connection.prepare("SELECT since FROM compatible WHERE version = ?"));
  if (!row->bind(version).step()) return std::nullopt;
  return row->integer(0);
}

void record_since(DatabaseConnection& connection, std::int64_t version, std::int64_t since) {
  const ScopedStatement record(
      connection.prepare("INSERT INTO compatible(version, since) VALUES (?, ?) "
                         "ON CONFLICT DO NOTHING"));
  record->bind(version).bind(since).step();
}

}  // namespace

void migrate(DatabaseConnection& connection, const Migrations& migrations) {
  Transaction transaction(connection);
  connection.run(
      "CREATE TABLE IF NOT EXISTS migration (version INTEGER PRIMARY KEY, "
      "applied TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP);"
      "CREATE TABLE IF NOT EXISTS compatible (version INTEGER PRIMARY KEY, "
      "since INTEGER NOT NULL)");
  const auto known = static_cast<std::int64_t>(migrations.steps.size());
  if (const std::int64_t found = newest_version(connection); found > known) {
    const auto since = compatible_since(connection, found);
    if (since && *since <= known) return;
    throw Failure("a newer version of Vitrine has changed its tables", ErrorCode::kUnsupported,
                  "install that version");
  }
  apply(connection, migrations.steps);
  record_since(connection, known, migrations.since);
  transaction.commit();
}

}  // namespace vitrine::server::sql
