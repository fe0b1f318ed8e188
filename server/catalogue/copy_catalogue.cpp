// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/copy_catalogue.h"

#include <fmt/core.h>

#include <algorithm>

namespace vitrine::server {
namespace {

using sql::DatabaseConnection;
using sql::ScopedStatement;

struct Table {
  std::string_view name, key, columns;
};

// The tables in the order of copying. Each table comes after the tables that its foreign keys
// reference.
constexpr Table kTables[] = {
    {"model", "id",
     "id, state, created, title, creator, rights, licence, unit, file, file_bytes, head_bytes, "
     "faces, vertices, more, accuracy, version, public_max_level, public_file, public_file_bytes, "
     "public_head_bytes, public_faces, public_vertices, texture_count, texture_side, "
     "texture_bytes, public_texture_count, public_texture_side, public_texture_bytes, repairs, "
     "presentation"},
    {"chunk", "sha256, model", "sha256, model, \"offset\", length"},
    {"annotation", "model, kind", "model, kind, version, entries, text"},
    {"visit", "model, day", "model, day, visits, seconds, levels, complete"},
    {"job", "id",
     "id, kind, state, scanner, scan, model, stage, progress, error, parameters, created, ended, "
     "webhook, attempts, told, fence, repairs, owner"},
    {"scan", "id",
     "id, job, scanner, public, title, parameters, steps, step, points, calibration, model, "
     "created, empty_rows, saturated_rows, doubled_rows, turn, built"},
    {"idempotency", "key", "key, request, job"},
    {"token", "id", "id, role, hash, label, created, revoked"}};

int count_columns(const Table& table) {
  return 1 + static_cast<int>(std::ranges::count(table.columns, ','));
}

std::string insertion(const Table& table) {
  std::string places = "?", changes;
  std::string_view rest = table.columns;
  for (int i = 1; i < count_columns(table); ++i)
    places += ",?";
  while (!rest.empty()) {
    const auto name = rest.substr(0, rest.find(','));
    changes += fmt::format("{0}{1} = excluded.{1}", changes.empty() ? "" : ", ", name);
    rest.remove_prefix(std::min(rest.size(), name.size() + 2));
  }
  return fmt::format("INSERT INTO {}({}) VALUES ({}) ON CONFLICT ({}) DO UPDATE SET {}", table.name,
                     table.columns, places, table.key, changes);
}

// Copies all rows of a table. Returns the number of rows.
std::int64_t copy_rows(DatabaseConnection& from, DatabaseConnection& to, const Table& table) {
  const ScopedStatement rows(
      from.prepare(fmt::format("SELECT {} FROM {}", table.columns, table.name)));
  std::int64_t copied = 0;
  for (; rows->step(); ++copied) {
    const ScopedStatement row(to.prepare(insertion(table)));
    for (int i = 0; i < count_columns(table); ++i)
      rows->bind_to(*row, i);
    row->step();
  }
  return copied;
}

std::int64_t count_rows(DatabaseConnection& connection, const Table& table) {
  const ScopedStatement row(connection.prepare(fmt::format("SELECT count(*) FROM {}", table.name)));
  row->step();
  return row->integer(0);
}

Expected<void> copy_tables(DatabaseConnection& from, DatabaseConnection& to) {
  sql::Transaction writing(to);
  for (const Table& table : kTables) {
    const std::int64_t copied = copy_rows(from, to, table);
    if (count_rows(to, table) != copied) {
      return fail(
          ErrorCode::kState,
          fmt::format("the destination already has a {} that the source does not have; choose "
                      "a new destination",
                      table.name));
    }
  }
  writing.commit();
  return {};
}

}  // namespace

Expected<void> copy_catalogue(sql::Database& from, sql::Database& to) {
  try {
    const auto reading = from.lease(), writing = to.lease();
    return copy_tables(*reading, *writing);
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot copy the catalogue", failure);
  }
}

}  // namespace vitrine::server
