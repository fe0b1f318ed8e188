// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres_migrations.h"

namespace vitrine::server::postgres {
namespace {

// The schema changes, numbered independently of the changes for SQLite. The first step creates the
// revision number and the same tables as the first six steps for SQLite. The revision number counts
// changes to models and tokens, but not the progress of jobs.
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
    R"sql(
ALTER TABLE model ADD COLUMN repairs TEXT NOT NULL DEFAULT '';
)sql",
    // A trigger derives these tables from the rows of `model`. `model_index` has a small row for
    // each model, with a full-text index of its words. `facet_value` has the values of the facets;
    // the column `facets` lists their ids.
    R"sql(
CREATE TABLE facet_value (
  id BIGSERIAL PRIMARY KEY, name TEXT NOT NULL, value TEXT NOT NULL COLLATE "C",
  UNIQUE (name, value)
);
CREATE TABLE model_index (
  model BYTEA PRIMARY KEY REFERENCES model(id) ON DELETE CASCADE, state BIGINT NOT NULL,
  title TEXT NOT NULL COLLATE "C", creator TEXT NOT NULL COLLATE "C", facets TEXT NOT NULL,
  words TSVECTOR NOT NULL
);
CREATE INDEX model_by_title ON model_index(title, model);
CREATE INDEX model_by_creator ON model_index(creator, model);
CREATE INDEX model_by_words ON model_index USING gin(words);
CREATE FUNCTION without_marks(words TEXT) RETURNS TEXT LANGUAGE plpgsql IMMUTABLE AS $$
BEGIN
  IF getdatabaseencoding() != 'UTF8' THEN RETURN lower(words); END IF;
  RETURN lower(regexp_replace(normalize(words, NFD), '[\u0300-\u036f]', '', 'g'));
END $$;
CREATE FUNCTION index_model() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  facet RECORD;
  number BIGINT;
  numbers TEXT := ' ';
  texts TEXT := concat_ws(' ', NEW.title, NEW.creator, NEW.rights, NEW.licence,
    (SELECT string_agg(value, ' ') FROM json_each_text(NEW.more::json)));
BEGIN
  FOR facet IN
    SELECT DISTINCT text.key AS name, btrim(part) COLLATE "C" AS value
    FROM jsonb_each_text(NEW.more::jsonb ||
           jsonb_build_object('creator', NEW.creator, 'licence', NEW.licence)) AS text,
      regexp_split_to_table(text.value, ';') AS part
    WHERE text.key IN ('subject', 'creator', 'period', 'material', 'licence', 'collection')
      AND btrim(part) != ''
    ORDER BY 1, 2
  LOOP
    SELECT id INTO number FROM facet_value WHERE name = facet.name AND value = facet.value;
    IF NOT FOUND THEN
      INSERT INTO facet_value(name, value) VALUES (facet.name, facet.value)
        ON CONFLICT (name, value) DO UPDATE SET name = excluded.name RETURNING id INTO number;
    END IF;
    numbers := numbers || number || ' ';
  END LOOP;
  INSERT INTO model_index VALUES (NEW.id, NEW.state, lower(NEW.title), lower(NEW.creator), numbers,
    to_tsvector('simple',
                regexp_replace(without_marks(texts), '[!-/:-@[-`{-~]+', ' ', 'g')))
    ON CONFLICT (model) DO UPDATE SET state = excluded.state, title = excluded.title,
      creator = excluded.creator, facets = excluded.facets, words = excluded.words;
  RETURN NULL;
END $$;
CREATE TRIGGER index_model AFTER INSERT OR UPDATE ON model
  FOR EACH ROW EXECUTE FUNCTION index_model();
DO $$ BEGIN
  IF EXISTS (SELECT 1 FROM model) THEN UPDATE model SET id = id; END IF;
END $$;
)sql",
    // The time of a model's last change, in seconds since 1970. The trigger above writes the row of
    // `model_index` at each change of its model.
    R"sql(
ALTER TABLE model_index ADD COLUMN changed BIGINT NOT NULL DEFAULT 0;
UPDATE model_index SET changed = (SELECT created / 1000 FROM model WHERE id = model);
CREATE INDEX model_by_change ON model_index(changed, model);
CREATE FUNCTION note_change() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  NEW.changed := floor(extract(epoch FROM clock_timestamp()));
  RETURN NEW;
END $$;
CREATE TRIGGER note_change BEFORE INSERT OR UPDATE ON model_index
  FOR EACH ROW EXECUTE FUNCTION note_change();
)sql",
    // How viewers and exports present a model, as JSON. Empty: as in its file.
    R"sql(
ALTER TABLE model ADD COLUMN presentation TEXT NOT NULL DEFAULT '';
)sql",
    // The notes of models and the tours through them, as JSON. Their changes count as changes of
    // models.
    R"sql(
CREATE TABLE annotation (
  model BYTEA NOT NULL REFERENCES model(id) ON DELETE CASCADE, kind BIGINT NOT NULL,
  version BIGINT NOT NULL, entries BIGINT NOT NULL, text TEXT NOT NULL,
  PRIMARY KEY (model, kind)
);
CREATE TRIGGER count_change AFTER INSERT OR UPDATE ON annotation
  FOR EACH STATEMENT EXECUTE FUNCTION count_change();
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
