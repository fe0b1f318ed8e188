// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres_migrations.h"

namespace vitrine::server::postgres {
namespace {

// The schema changes. Their numbers are independent of those for SQLite. The first step creates the
// revision number and the tables that SQLite has after its first six steps. The revision counts
// changes to models and tokens, not the progress of jobs.
constexpr const char* kSteps[] = {
    R"sql(
CREATE TABLE model (
  id BYTEA PRIMARY KEY, state BIGINT NOT NULL, created BIGINT NOT NULL,
  title TEXT NOT NULL, creator TEXT NOT NULL, rights TEXT NOT NULL, licence TEXT NOT NULL,
  unit TEXT NOT NULL, file BYTEA NOT NULL, file_bytes BIGINT NOT NULL,
  head_bytes BIGINT NOT NULL, faces BIGINT NOT NULL, vertices BIGINT NOT NULL,
  more TEXT NOT NULL, accuracy DOUBLE PRECISION, version BIGINT NOT NULL,
  public_max_level BIGINT, public_file BYTEA, public_file_bytes BIGINT,
  public_head_bytes BIGINT, public_faces BIGINT, public_vertices BIGINT
);
CREATE INDEX model_of_file ON model(file);
CREATE TABLE chunk (
  sha256 BYTEA NOT NULL, model BYTEA NOT NULL REFERENCES model(id) ON DELETE CASCADE,
  "offset" BIGINT NOT NULL, length BIGINT NOT NULL,
  PRIMARY KEY (sha256, model)
);
CREATE INDEX chunk_of_model ON chunk(model);
CREATE TABLE job (
  id BYTEA PRIMARY KEY, kind BIGINT NOT NULL, state BIGINT NOT NULL, scanner TEXT NOT NULL,
  scan BYTEA, model BYTEA, stage TEXT NOT NULL, progress DOUBLE PRECISION NOT NULL,
  error TEXT NOT NULL, parameters TEXT NOT NULL, created BIGINT NOT NULL, ended BIGINT NOT NULL,
  webhook TEXT NOT NULL, attempts BIGINT NOT NULL, told BIGINT NOT NULL DEFAULT 0
);
CREATE TABLE scan (
  id BYTEA PRIMARY KEY, job BYTEA NOT NULL REFERENCES job(id), scanner TEXT NOT NULL,
  public BIGINT NOT NULL, title TEXT NOT NULL, parameters TEXT NOT NULL, steps BIGINT NOT NULL,
  step BIGINT NOT NULL, points BIGINT NOT NULL, calibration BIGINT NOT NULL, model BYTEA,
  created BIGINT NOT NULL, empty_rows DOUBLE PRECISION, saturated_rows DOUBLE PRECISION,
  doubled_rows DOUBLE PRECISION
);
CREATE TABLE idempotency (
  key TEXT PRIMARY KEY, request BYTEA NOT NULL, job BYTEA NOT NULL REFERENCES job(id)
);
CREATE TABLE token (
  id BYTEA PRIMARY KEY, role BIGINT NOT NULL, hash BYTEA NOT NULL UNIQUE, label TEXT NOT NULL,
  created BIGINT NOT NULL, revoked BIGINT,
  prefix BYTEA NOT NULL GENERATED ALWAYS AS (substr(hash, 1, 4)) STORED
);
CREATE INDEX token_by_prefix ON token(prefix);
CREATE TABLE revision (number BIGINT NOT NULL);
INSERT INTO revision VALUES (1);
CREATE FUNCTION count_change() RETURNS trigger LANGUAGE plpgsql AS
  'BEGIN UPDATE revision SET number = number + 1; RETURN NULL; END';
CREATE TRIGGER count_change AFTER INSERT OR UPDATE OR DELETE ON model
  FOR EACH STATEMENT EXECUTE FUNCTION count_change();
CREATE TRIGGER count_change AFTER INSERT OR UPDATE OR DELETE ON token
  FOR EACH STATEMENT EXECUTE FUNCTION count_change();
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN fence BIGINT NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN holder TEXT NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN lease BIGINT NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN cancelled BIGINT NOT NULL DEFAULT 0;
CREATE INDEX job_of_state ON job(state);
CREATE INDEX job_untold ON job(id) WHERE told != 1 AND webhook != '';
)sql",
    R"sql(
CREATE TABLE scanner (
  name TEXT PRIMARY KEY, holder TEXT NOT NULL, address TEXT NOT NULL, lease BIGINT NOT NULL,
  epoch BIGINT NOT NULL
);
)sql",
    R"sql(
ALTER TABLE scan ADD COLUMN turn TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
ALTER TABLE scan ADD COLUMN built BYTEA;
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN repairs TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
ALTER TABLE model ADD COLUMN texture_count BIGINT NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN texture_side BIGINT NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN texture_bytes BIGINT NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_texture_count BIGINT NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_texture_side BIGINT NOT NULL DEFAULT 0;
ALTER TABLE model ADD COLUMN public_texture_bytes BIGINT NOT NULL DEFAULT 0;
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN owner TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
CREATE TABLE visit (
  model BYTEA NOT NULL REFERENCES model(id) ON DELETE CASCADE, day BIGINT NOT NULL,
  visits BIGINT NOT NULL, seconds BIGINT NOT NULL, levels BIGINT NOT NULL,
  complete BIGINT NOT NULL,
  PRIMARY KEY (model, day)
);
CREATE INDEX visit_of_day ON visit(day);
)sql",
};
constexpr std::int64_t kSince = 1;
constexpr const char* kOneAtATime = "SELECT pg_advisory_lock(7957706764961114213)";
constexpr const char* kNext = "SELECT pg_advisory_unlock(7957706764961114213)";

}  // namespace

void migrate(sql::DatabaseConnection& connection) {
  connection.run(kOneAtATime);
  sql::migrate(connection, {.steps = kSteps, .since = kSince});
  connection.run(kNext);
}

}  // namespace vitrine::server::postgres
