// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sqlite_database.h"

#include <fmt/core.h>

#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "server/catalogue/private_file.h"
#include "server/catalogue/sqlite.h"

namespace vitrine::server::sqlite {
namespace {

constexpr const char* kSteps[] = {
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
    // The revision counts changes to models and tokens, not the progress of jobs.
    R"sql(
ALTER TABLE job ADD COLUMN fence INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN holder TEXT NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN lease INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN cancelled INTEGER NOT NULL DEFAULT 0;
CREATE INDEX job_of_state ON job(state);
CREATE INDEX job_untold ON job(id) WHERE told != 1 AND webhook != '';
CREATE TABLE revision (number INTEGER NOT NULL);
INSERT INTO revision VALUES (1);
CREATE TRIGGER model_added AFTER INSERT ON model BEGIN UPDATE revision SET number = number + 1; END;
CREATE TRIGGER model_changed AFTER UPDATE ON model BEGIN UPDATE revision SET number = number + 1; END;
CREATE TRIGGER model_removed AFTER DELETE ON model BEGIN UPDATE revision SET number = number + 1; END;
CREATE TRIGGER token_added AFTER INSERT ON token BEGIN UPDATE revision SET number = number + 1; END;
CREATE TRIGGER token_changed AFTER UPDATE ON token BEGIN UPDATE revision SET number = number + 1; END;
)sql",
    R"sql(
CREATE TABLE scanner (
  name TEXT PRIMARY KEY, holder TEXT NOT NULL, address TEXT NOT NULL, lease INTEGER NOT NULL,
  epoch INTEGER NOT NULL
) WITHOUT ROWID;
)sql",
    R"sql(
ALTER TABLE scan ADD COLUMN turn TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
ALTER TABLE scan ADD COLUMN built BLOB;
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN repairs TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
ALTER TABLE model ADD COLUMN texture_count INTEGER NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN texture_side INTEGER NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN texture_bytes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_texture_count INTEGER NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_texture_side INTEGER NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_texture_bytes INTEGER NOT NULL DEFAULT 0;
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN owner TEXT NOT NULL DEFAULT '';
)sql",
    // These indices serve the integrity check: it compares each row with its index entries, and so
    // finds changed values. The indices contain all columns that matter. No query filters by their
    // first columns, so the query planner does not choose these indices.
    R"sql(
CREATE INDEX model_guard ON model(
  created, state, title, creator, rights, licence, unit, file, file_bytes, head_bytes, faces,
  vertices, more, accuracy, version, public_max_level, public_file, public_file_bytes,
  public_head_bytes, public_faces, public_vertices, texture_count, texture_side, texture_bytes,
  public_texture_count, public_texture_side, public_texture_bytes);
CREATE INDEX job_guard ON job(
  created, kind, state, scanner, scan, model, error, parameters, ended, webhook, attempts, told,
  fence, cancelled, repairs, owner);
CREATE INDEX scan_guard ON scan(
  created, job, scanner, public, title, parameters, steps, step, points, calibration, model,
  empty_rows, saturated_rows, doubled_rows, turn, built);
CREATE INDEX idempotency_guard ON idempotency(request, job);
CREATE INDEX token_guard ON token(created, role, hash, label, revoked);
DROP INDEX chunk_of_model;
CREATE INDEX chunk_of_model ON chunk(model, offset, length);
)sql",
    // The index visit_of_day lets the integrity check find changed values, as the indices above do.
    // It also serves queries for a range of days.
    R"sql(
CREATE TABLE visit (
  model BLOB NOT NULL REFERENCES model(id) ON DELETE CASCADE, day INTEGER NOT NULL,
  visits INTEGER NOT NULL, seconds INTEGER NOT NULL, levels INTEGER NOT NULL,
  complete INTEGER NOT NULL,
  PRIMARY KEY (model, day)
) WITHOUT ROWID;
CREATE INDEX visit_of_day ON visit(day, visits, seconds, levels, complete);
)sql",
    R"sql(
ALTER TABLE model ADD COLUMN repairs TEXT NOT NULL DEFAULT '';
DROP INDEX model_guard;
CREATE INDEX model_guard ON model(
  created, state, title, creator, rights, licence, unit, file, file_bytes, head_bytes, faces,
  vertices, more, accuracy, version, public_max_level, public_file, public_file_bytes,
  public_head_bytes, public_faces, public_vertices, texture_count, texture_side, texture_bytes,
  public_texture_count, public_texture_side, public_texture_bytes, repairs);
)sql",
    // Triggers derive these tables from the rows of `model`. `model_index` has a small row for each
    // model. `facet_value` has the values of the facets; the column `facets` lists their ids.
    // `model_words` is a full-text index without a copy of the texts, so the removal of a row needs
    // the row's text.
    R"sql(
CREATE TABLE facet_value (
  id INTEGER PRIMARY KEY, name TEXT NOT NULL, value TEXT NOT NULL, UNIQUE (name, value)
);
CREATE TABLE model_index (
  number INTEGER PRIMARY KEY, model BLOB NOT NULL UNIQUE, state INTEGER NOT NULL,
  title TEXT NOT NULL, creator TEXT NOT NULL, facets TEXT NOT NULL
);
CREATE INDEX model_by_title ON model_index(title, model);
CREATE INDEX model_by_creator ON model_index(creator, model);
CREATE VIRTUAL TABLE model_words USING fts5(
  words, content = '', tokenize = 'unicode61 remove_diacritics 2', prefix = '1 2 3');
CREATE VIEW model_text AS
  SELECT number, model.id AS model, model.title||' '||model.creator||' '||rights||' '||licence||' '||
    coalesce((SELECT group_concat(value, ' ')
              FROM json_each(CASE WHEN json_valid(more) THEN more ELSE '{}' END)), '') AS words
  FROM model JOIN model_index ON model_index.model = model.id;
CREATE VIEW model_facet AS
  SELECT model.id AS model, text.key AS name, trim(part.value) AS value
  FROM model,
    json_each(json_patch(CASE WHEN json_valid(more) THEN more ELSE '{}' END,
                         json_object('creator', creator, 'licence', licence))) AS text,
    json_each('[' || replace(json_quote(text.value), ';', '","') || ']') AS part
  WHERE text.key IN ('subject', 'creator', 'period', 'material', 'licence', 'collection')
    AND trim(part.value) != '';
CREATE VIEW model_entry AS
  SELECT id AS model, state, lower(title) AS title, lower(creator) AS creator,
    ' ' || coalesce((SELECT group_concat(facet_value.id, ' ')
                     FROM model_facet JOIN facet_value USING (name, value)
                     WHERE model_facet.model = model.id), '') || ' ' AS facets
  FROM model;
INSERT INTO facet_value(name, value) SELECT DISTINCT name, value FROM model_facet;
INSERT INTO model_index(model, state, title, creator, facets)
  SELECT model, state, title, creator, facets FROM model_entry ORDER BY model;
INSERT INTO model_words(rowid, words) SELECT number, words FROM model_text;
CREATE TRIGGER text_added AFTER INSERT ON model BEGIN
  INSERT INTO facet_value(name, value)
    SELECT DISTINCT name, value FROM model_facet AS f
    WHERE model = new.id AND NOT EXISTS
      (SELECT 1 FROM facet_value AS v WHERE v.name = f.name AND v.value = f.value);
  INSERT INTO model_index(model, state, title, creator, facets)
    SELECT model, state, title, creator, facets FROM model_entry WHERE model = new.id;
  INSERT INTO model_words(rowid, words) SELECT number, words FROM model_text WHERE model = new.id;
END;
CREATE TRIGGER text_changes BEFORE UPDATE ON model BEGIN
  INSERT INTO model_words(model_words, rowid, words)
    SELECT 'delete', number, words FROM model_text WHERE model = old.id;
END;
CREATE TRIGGER text_changed AFTER UPDATE ON model BEGIN
  INSERT INTO facet_value(name, value)
    SELECT DISTINCT name, value FROM model_facet AS f
    WHERE model = new.id AND NOT EXISTS
      (SELECT 1 FROM facet_value AS v WHERE v.name = f.name AND v.value = f.value);
  UPDATE model_index SET (state, title, creator, facets) =
    (SELECT state, title, creator, facets FROM model_entry WHERE model = new.id)
    WHERE model = new.id;
  INSERT INTO model_words(rowid, words) SELECT number, words FROM model_text WHERE model = new.id;
END;
CREATE TRIGGER text_removed BEFORE DELETE ON model BEGIN
  INSERT INTO model_words(model_words, rowid, words)
    SELECT 'delete', number, words FROM model_text WHERE model = old.id;
  DELETE FROM model_index WHERE model = old.id;
END;
)sql",
    // The time of a model's last change, in seconds since 1970. The triggers above write the row of
    // `model_index` at each change of its model.
    R"sql(
ALTER TABLE model_index ADD COLUMN changed INTEGER NOT NULL DEFAULT 0;
UPDATE model_index SET changed = (SELECT created / 1000 FROM model WHERE id = model);
CREATE INDEX model_by_change ON model_index(changed, model);
CREATE TRIGGER change_added AFTER INSERT ON model_index BEGIN
  UPDATE model_index SET changed = CAST(strftime('%s', 'now') AS INTEGER)
    WHERE number = new.number;
END;
CREATE TRIGGER change_made AFTER UPDATE OF state ON model_index BEGIN
  UPDATE model_index SET changed = CAST(strftime('%s', 'now') AS INTEGER)
    WHERE number = new.number;
END;
)sql",
    // How viewers and exports present a model, as JSON. Empty: as in its file.
    R"sql(
ALTER TABLE model ADD COLUMN presentation TEXT NOT NULL DEFAULT '';
DROP INDEX model_guard;
CREATE INDEX model_guard ON model(
  created, state, title, creator, rights, licence, unit, file, file_bytes, head_bytes, faces,
  vertices, more, accuracy, version, public_max_level, public_file, public_file_bytes,
  public_head_bytes, public_faces, public_vertices, texture_count, texture_side, texture_bytes,
  public_texture_count, public_texture_side, public_texture_bytes, repairs, presentation);
)sql",
    // The notes of models and the tours through them, as JSON. Their changes count as changes of
    // models.
    R"sql(
CREATE TABLE annotation (
  model BLOB NOT NULL REFERENCES model(id) ON DELETE CASCADE, kind INTEGER NOT NULL,
  version INTEGER NOT NULL, entries INTEGER NOT NULL, text TEXT NOT NULL,
  PRIMARY KEY (model, kind)
) WITHOUT ROWID;
CREATE INDEX annotation_guard ON annotation(version, entries, text);
CREATE TRIGGER annotation_added AFTER INSERT ON annotation
  BEGIN UPDATE revision SET number = number + 1; END;
CREATE TRIGGER annotation_changed AFTER UPDATE ON annotation
  BEGIN UPDATE revision SET number = number + 1; END;
)sql",
};
// Programs made for tables before version 8 cannot use the newest tables.
constexpr std::int64_t kSince = 8;

class SqliteConnection final : public sql::DatabaseConnection {
 public:
  explicit SqliteConnection(const std::string& file) : database_(file) {}

  void run(const char* sql) override { database_.run(sql); }
  sql::Statement& prepare(const std::string& sql) override {
    auto& statement = statements_[sql];
    if (!statement) statement = std::make_unique<SqliteStatement>(database_, sql);
    return *statement;
  }
  // Acquires the write lock at once. Two transactions that both began as readers could deadlock
  // when they start to write.
  void begin() override {
    if (sqlite3_get_autocommit(database_.handle()) == 0)
      roll_back();  // an earlier rollback failed for lack of memory
    run("BEGIN IMMEDIATE");
  }
  void roll_back() noexcept override {
    try {
      roll_back_.reset().step();
    } catch (const std::exception&) {  // catches std::bad_alloc; the next begin() rolls back
    }
  }
  std::uint64_t revision() override {
    const sql::ScopedStatement row(prepare("SELECT number FROM revision"));
    row->step();
    return static_cast<std::uint64_t>(row->integer(0));
  }
  const char* text_condition() const override {
    return "number IN (SELECT rowid FROM model_words WHERE model_words MATCH ?)";
  }
  std::string text_query(std::span<const std::string> words) const override {
    std::string query;
    for (const std::string& word : words)
      query += '"' + word + "\"* ";
    return query;
  }
  const char* by_bytes() const override { return ""; }
  const char* now() const override {
    return "CAST((julianday('now') - 2440587.5) * 86400000 AS INTEGER)";
  }
  // No clause is needed, since begin() admits only one writer at a time.
  const char* skip_locked() const override { return ""; }

 private:
  SqliteHandle database_;
  // Prepared in advance, because a rollback must work even if no memory is left.
  SqliteStatement roll_back_{database_, "ROLLBACK"};
  std::map<std::string, std::unique_ptr<SqliteStatement>> statements_;
};

constexpr const char* kMemory = ":memory:";  // the name of a database without a file

class SqliteDatabase final : public sql::Database {
 public:
  explicit SqliteDatabase(std::string file) : file_(std::move(file)) { open(); }

  // Opens a new connection if the last use of the connection failed. If memory ran out, the
  // full-text index may be wrong in the connection's memory, although it is right in the file.
  std::shared_ptr<sql::DatabaseConnection> lease() override {
    std::unique_lock lock(mutex_);
    if (has_failed_ && file_ != kMemory) connection_.reset();
    if (!connection_) open();
    lock.release();
    return {&*connection_, [this](sql::DatabaseConnection*) {
              has_failed_ = std::uncaught_exceptions() > 0;
              mutex_.unlock();
            }};
  }

 private:
  void open() {
    connection_.emplace(file_);
    try {
      connection_->run(
          "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
    } catch (...) {
      connection_.reset();
      throw;
    }
  }

  const std::string file_;
  std::mutex mutex_;  // guards the members below
  std::optional<SqliteConnection> connection_;
  bool has_failed_ = false;  // whether an exception ended the last use of the connection
};

}  // namespace

std::shared_ptr<sql::Database> newest_tables() {
  auto database = std::make_shared<SqliteDatabase>(kMemory);
  sql::migrate(*database->lease(), {.steps = kSteps, .since = kSince});
  return database;
}

Expected<std::shared_ptr<sql::Database>> open_database(const std::filesystem::path& file) {
  ensure_private_file(file);  // SQLite gives the files beside it the same permissions
  for (const char* const ending : {"", "-wal", "-shm"})  // older daemons left them readable
    make_private(file.string() + ending);
  try {
    auto database = std::make_shared<SqliteDatabase>(file.string());
    const auto connection = database->lease();
    sql::migrate(*connection, {.steps = kSteps, .since = kSince});
    return database;
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot open the catalogue " + file.string(), failure);
  }
}

}  // namespace vitrine::server::sqlite
