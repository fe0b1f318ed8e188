// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql.h"

#include <algorithm>

namespace vitrine::sql {

bool Statement::any() {
  bool found = false;
  while (step())
    found = true;
  return found;
}

std::int64_t migrate(Connection& connection, std::span<const char* const> migrations) {
  Transaction transaction(connection);
  connection.run(
      "CREATE TABLE IF NOT EXISTS migration (version INTEGER PRIMARY KEY, "
      "applied TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP)");
  std::int64_t found = 0;
  {
    const Query newest(connection.prepare("SELECT coalesce(max(version), 0) FROM migration"));
    newest->step();
    found = newest->integer(0);
  }
  const auto wanted = static_cast<std::int64_t>(migrations.size());
  for (std::int64_t version = found; version < wanted; ++version) {
    connection.run(migrations[static_cast<std::size_t>(version)]);
    const Query record(connection.prepare("INSERT INTO migration(version) VALUES (?)"));
    record->bind(version + 1).step();
  }
  transaction.commit();
  return std::max(found, wanted);
}

}  // namespace vitrine::sql
