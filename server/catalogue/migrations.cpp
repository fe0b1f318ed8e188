// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/migrations.h"

#include <fmt/core.h>

#include <algorithm>

namespace vitrine::sqlite {
namespace {

// Migration i leads from schema version i to i + 1. Never edit one that has been released.
constexpr const char* kMigrations[] = {
    R"sql(
CREATE TABLE model (
  id BLOB PRIMARY KEY, state INTEGER NOT NULL, created INTEGER NOT NULL,
  title TEXT NOT NULL, creator TEXT NOT NULL, rights TEXT NOT NULL, licence TEXT NOT NULL,
  unit TEXT NOT NULL, file BLOB NOT NULL, file_bytes INTEGER NOT NULL,
  head_bytes INTEGER NOT NULL, faces INTEGER NOT NULL, vertices INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE chunk (
  sha256 BLOB NOT NULL, model BLOB NOT NULL REFERENCES model(id) ON DELETE CASCADE,
  offset INTEGER NOT NULL, length INTEGER NOT NULL,
  PRIMARY KEY (sha256, model)
) WITHOUT ROWID;
CREATE INDEX chunk_of_model ON chunk(model);
)sql",
    R"sql(
CREATE TABLE job (
  id BLOB PRIMARY KEY, kind INTEGER NOT NULL, state INTEGER NOT NULL, scanner TEXT NOT NULL,
  scan BLOB, model BLOB, stage TEXT NOT NULL, progress REAL NOT NULL, error TEXT NOT NULL,
  parameters TEXT NOT NULL, created INTEGER NOT NULL, ended INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE scan (
  id BLOB PRIMARY KEY, job BLOB NOT NULL REFERENCES job(id), scanner TEXT NOT NULL,
  public INTEGER NOT NULL, title TEXT NOT NULL, parameters TEXT NOT NULL, steps INTEGER NOT NULL,
  step INTEGER NOT NULL, points INTEGER NOT NULL, calibration INTEGER NOT NULL, model BLOB,
  created INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE idempotency (
  key TEXT PRIMARY KEY, request BLOB NOT NULL, job BLOB NOT NULL REFERENCES job(id)
) WITHOUT ROWID;
)sql",
    R"sql(
CREATE TABLE token (
  id BLOB PRIMARY KEY, role INTEGER NOT NULL, hash BLOB NOT NULL UNIQUE, label TEXT NOT NULL,
  created INTEGER NOT NULL, revoked INTEGER,
  prefix BLOB NOT NULL GENERATED ALWAYS AS (substr(hash, 1, 4)) VIRTUAL
) WITHOUT ROWID;
CREATE INDEX token_by_prefix ON token(prefix);
)sql",
    R"sql(
ALTER TABLE scan ADD COLUMN empty_rows REAL;
ALTER TABLE scan ADD COLUMN saturated_rows REAL;
ALTER TABLE scan ADD COLUMN doubled_rows REAL;
)sql",
    R"sql(
ALTER TABLE model ADD COLUMN more TEXT NOT NULL DEFAULT '{}';
ALTER TABLE model ADD COLUMN accuracy REAL;
ALTER TABLE model ADD COLUMN version INTEGER NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_max_level INTEGER;
ALTER TABLE model ADD COLUMN public_file BLOB;
ALTER TABLE model ADD COLUMN public_file_bytes INTEGER;
ALTER TABLE model ADD COLUMN public_head_bytes INTEGER;
ALTER TABLE model ADD COLUMN public_faces INTEGER;
ALTER TABLE model ADD COLUMN public_vertices INTEGER;
ALTER TABLE job ADD COLUMN webhook TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN attempts INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN told INTEGER NOT NULL DEFAULT 0;
UPDATE job SET told = 1 WHERE state >= 3;
)sql",
};
constexpr std::int64_t kSchemaVersion = std::size(kMigrations);

// Returns the version found where that is newer than ours, else ours.
std::int64_t migrate(Database& database) {
  Transaction transaction(database);
  database.run(
      "CREATE TABLE IF NOT EXISTS migration (version INTEGER PRIMARY KEY, "
      "applied TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP)");
  Statement newest(database, "SELECT coalesce(max(version), 0) FROM migration");
  newest.step();
  const std::int64_t found = newest.integer(0);
  newest.reset();
  Statement record(database, "INSERT INTO migration(version) VALUES (?)");
  for (std::int64_t version = found; version < kSchemaVersion; ++version) {
    database.run(kMigrations[version]);
    record.reset().bind(version + 1).step();
  }
  transaction.commit();
  return std::max(found, kSchemaVersion);
}

}  // namespace

Unexpected refused(const std::string& what, const sqlite::Failure& failure) {
  return fail(failure.disk_full ? ErrorCode::kLimit : ErrorCode::kIo,
              fmt::format("{}: {}; {}", what, failure.what(),
                          failure.disk_full ? "free some space or choose another data folder"
                                            : "check the data folder"));
}

Expected<Database> open_database(const std::filesystem::path& file) {
  try {
    Database database(file.string());
    database.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
    if (migrate(database) > kSchemaVersion) {
      return fail(ErrorCode::kUnsupported,
                  fmt::format("{} was written by a newer version of Vitrine; install that version",
                              file.string()));
    }
    return database;
  } catch (const Failure& failure) {
    return refused("cannot open the catalogue " + file.string(), failure);
  }
}

}  // namespace vitrine::sqlite
