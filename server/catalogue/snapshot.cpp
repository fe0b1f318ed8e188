// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/snapshot.h"

#include "server/catalogue/private_file.h"
#include "server/catalogue/sqlite.h"

namespace vitrine {

// In one step, which holds a read lock: writers are not held up, as the write-ahead log takes them.
Expected<void> snapshot_sqlite(const std::filesystem::path& from, const std::filesystem::path& to) {
  try {
    const sqlite::Database source(from.string());
    static_cast<void>(create_private_file(to));  // what is refused here is refused and told below
    const sqlite::Database copy(to.string());
    sqlite3_backup* backup = sqlite3_backup_init(copy.handle(), "main", source.handle(), "main");
    if (backup == nullptr) copy.raise();
    sqlite3_backup_step(backup, -1);
    if (sqlite3_backup_finish(backup) != SQLITE_OK) copy.raise();
    return {};
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot copy the catalogue " + from.string(), failure);
  }
}

}  // namespace vitrine
