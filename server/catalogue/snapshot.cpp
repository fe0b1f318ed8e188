// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/snapshot.h"

#include "server/catalogue/private_file.h"
#include "server/catalogue/sqlite.h"

namespace vitrine::server {

// Copies all pages in one step under a read lock. Writers are not blocked, because they append to
// the write-ahead log.
Expected<void> snapshot_sqlite(const std::filesystem::path& from, const std::filesystem::path& to) {
  try {
    const sqlite::SqliteHandle source(from.string());
    // An error is ignored here, because opening the file below then fails as well.
    static_cast<void>(create_private_file(to));
    const sqlite::SqliteHandle copy(to.string());
    sqlite3_backup* backup = sqlite3_backup_init(copy.handle(), "main", source.handle(), "main");
    if (backup == nullptr) copy.raise();
    sqlite3_backup_step(backup, -1);
    if (sqlite3_backup_finish(backup) != SQLITE_OK) copy.raise();
    return {};
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot copy the catalogue " + from.string(), failure);
  }
}

}  // namespace vitrine::server
