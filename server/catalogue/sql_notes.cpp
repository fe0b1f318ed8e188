// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "server/catalogue/sql_catalogue.h"

namespace vitrine::server {
namespace {

const std::string kFindSheet =
    "SELECT version, entries, text FROM annotation WHERE model = ? AND kind = ?";
const std::string kChangeSheet =
    "UPDATE annotation SET version = version + 1, entries = ?4, text = ?5 "
    "WHERE model = ?1 AND kind = ?2 AND version = ?3 RETURNING 1";
const std::string kAddSheet =
    "INSERT INTO annotation(model, kind, version, entries, text) "
    "SELECT id, ?2, 1, ?3, ?4 FROM model WHERE id = ?1 ON CONFLICT DO NOTHING RETURNING 1";

std::int64_t kind_number(NoteKind kind) {
  return static_cast<std::int64_t>(kind);
}

class SqlNotes final : public NoteCatalogue {
 public:
  explicit SqlNotes(std::shared_ptr<sql::Database> database) : database_(std::move(database)) {}

  Expected<NoteSheet> find(const ModelId& model, NoteKind kind) override {
    const auto run = [&](sql::DatabaseConnection& connection) -> Expected<NoteSheet> {
      const sql::ScopedStatement row(connection.prepare(kFindSheet));
      if (!row->bind(model.bytes()).bind(kind_number(kind)).step()) return NoteSheet();
      return NoteSheet{sql::count(*row, 0), static_cast<std::uint32_t>(row->integer(1)),
                       row->text(2)};
    };
    return sql::with_connection(*database_, run);
  }

  Expected<void> put(const ModelId& model, NoteKind kind, const NoteSheet& sheet) override {
    const auto run = [&](sql::DatabaseConnection& connection) -> Expected<void> {
      const bool is_new = sheet.version == 0;
      const sql::ScopedStatement row(connection.prepare(is_new ? kAddSheet : kChangeSheet));
      row->bind(model.bytes()).bind(kind_number(kind));
      if (!is_new) row->bind(sql::number(sheet.version));
      if (row->bind(std::int64_t{sheet.entries}).bind(sheet.text).any()) return {};
      return fail(ErrorCode::kState,
                  fmt::format("the notes of model {} were changed or the model was removed "
                              "meanwhile; read them again",
                              model.to_string()));
    };
    return sql::with_connection(*database_, run);
  }

 private:
  const std::shared_ptr<sql::Database> database_;
};

}  // namespace

std::unique_ptr<NoteCatalogue> make_notes(std::shared_ptr<sql::Database> database) {
  return std::make_unique<SqlNotes>(std::move(database));
}

}  // namespace vitrine::server
