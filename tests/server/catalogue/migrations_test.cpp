// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>

#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

// SQL that reverts the current schema to that of the last version without notes.
const std::string kBeforeNotes = "DROP TABLE annotation;";

// SQL that reverts the current schema to that of the last version without presentations.
const std::string kBeforePresentations =
    kBeforeNotes +
    "DROP INDEX model_guard; ALTER TABLE model DROP COLUMN presentation;"
    "CREATE INDEX model_guard ON model(title);";

// SQL that reverts the current schema to that of the last version without full-text search.
const std::string kBeforeSearch =
    kBeforePresentations +
    "DROP TRIGGER text_added; DROP TRIGGER text_changes; DROP TRIGGER text_changed;"
    "DROP TRIGGER text_removed; DROP VIEW model_text; DROP VIEW model_facet; DROP VIEW model_entry;"
    "DROP TABLE facet_value; DROP TABLE model_index; DROP TABLE model_words;";

// SQL that reverts the current schema to that of the last version in which daemons could not claim
// jobs.
const std::string kBeforeClaims =
    kBeforeSearch +
    "DROP INDEX model_guard; DROP INDEX job_guard; DROP INDEX scan_guard; DROP INDEX token_guard;"
    "DROP INDEX idempotency_guard; DROP INDEX job_untold; DROP INDEX job_of_state; DROP TABLE "
    "revision; DROP TABLE scanner; DROP TABLE visit;"
    "DROP TRIGGER model_added; DROP TRIGGER model_changed; DROP TRIGGER model_removed;"
    "DROP TRIGGER token_added; DROP TRIGGER token_changed;"
    "ALTER TABLE scan DROP COLUMN built; ALTER TABLE scan DROP COLUMN turn; ALTER TABLE job DROP "
    "COLUMN fence; ALTER TABLE job DROP "
    "COLUMN holder;"
    "ALTER TABLE job DROP COLUMN lease; ALTER TABLE job DROP COLUMN cancelled;"
    "ALTER TABLE job DROP COLUMN repairs; ALTER TABLE job DROP COLUMN owner;"
    "ALTER TABLE model DROP COLUMN texture_count; ALTER TABLE model DROP COLUMN texture_side;"
    "ALTER TABLE model DROP COLUMN texture_bytes;"
    "ALTER TABLE model DROP COLUMN public_texture_count;"
    "ALTER TABLE model DROP COLUMN public_texture_side;"
    "ALTER TABLE model DROP COLUMN public_texture_bytes;"
    "ALTER TABLE model DROP COLUMN repairs;";

class Migrations : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "catalogue.sqlite";

  void run(const std::string& sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }
};

TEST_F(Migrations, OpeningTwiceKeepsWhatIsThere) {
  ModelRecord model;
  model.id = ModelId::generate();
  ASSERT_TRUE(open_sqlite_catalogue(file_).value()->add(model, {}));
  EXPECT_TRUE(open_sqlite_catalogue(file_).value()->find(model.id).value());
}

TEST_F(Migrations, AScanOfAnOlderVersionDoesNotKnowItsRows) {
  const ScanEntry scan{.id = ScanId::generate(), .job = JobId::generate(), .steps = 720};
  ASSERT_TRUE(open_sqlite_jobs(file_).value()->add({.id = scan.job}, scan, {}));
  run(kBeforeClaims +
      "ALTER TABLE scan DROP COLUMN empty_rows; ALTER TABLE scan DROP COLUMN saturated_rows;"
      "ALTER TABLE scan DROP COLUMN doubled_rows; DELETE FROM migration WHERE version >= 4;"
      "ALTER TABLE job DROP COLUMN webhook; ALTER TABLE job DROP COLUMN attempts;"
      "ALTER TABLE job DROP COLUMN told; ALTER TABLE model DROP COLUMN more;"
      "ALTER TABLE model DROP COLUMN accuracy; ALTER TABLE model DROP COLUMN version;"
      "ALTER TABLE model DROP COLUMN public_max_level; ALTER TABLE model DROP COLUMN public_file;"
      "ALTER TABLE model DROP COLUMN public_file_bytes;"
      "ALTER TABLE model DROP COLUMN public_head_bytes;"
      "ALTER TABLE model DROP COLUMN public_faces; ALTER TABLE model DROP COLUMN public_vertices");
  EXPECT_EQ(open_sqlite_jobs(file_).value()->find_scan(scan.id).value(), scan);
}

TEST_F(Migrations, JobsThatEndedBeforeWebhooksExistedCallNone) {
  const JobRecord ended{.id = JobId::generate(), .state = JobState::kDone, .webhook = "http://a/"};
  ASSERT_TRUE(open_sqlite_jobs(file_).value()->add(ended, {}, {}));
  EXPECT_EQ(open_sqlite_jobs(file_).value()->unnotified_jobs().value().size(), 1u);
  run(kBeforeClaims +
      "ALTER TABLE job DROP COLUMN attempts; ALTER TABLE job DROP COLUMN told;"
      "DELETE FROM migration WHERE version >= 6");
  EXPECT_TRUE(open_sqlite_jobs(file_).value()->unnotified_jobs().value().empty());
}

TEST_F(Migrations, RepairsOfModelsFromBeforeTheyWereKeptAreNotKnown) {
  ModelRecord model;
  model.id = ModelId::generate();
  model.title = "Bust";
  ASSERT_TRUE(open_sqlite_catalogue(file_).value()->add(model, {}));
  run(kBeforeSearch +
      "DROP INDEX model_guard; ALTER TABLE model DROP COLUMN repairs;"
      "CREATE INDEX model_guard ON model(title);"
      "DELETE FROM migration WHERE version >= 16");
  const auto catalogue = open_sqlite_catalogue(file_).value();
  ModelRecord found = catalogue->find(model.id).value().value();
  EXPECT_EQ(found.title, "Bust");
  EXPECT_EQ(found.repairs, "");
  found.repairs = "1 duplicate face dropped";
  ASSERT_TRUE(catalogue->update(found, std::nullopt));
  EXPECT_EQ(catalogue->find(model.id).value()->repairs, found.repairs);
}

TEST_F(Migrations, ModelsFromBeforeTheFullTextSearchAreFound) {
  ModelRecord model{.id = ModelId::generate(), .state = ModelState::kPublished};
  model.created = 1'700'000'000'500;
  model.more = {{"material", "bronze; gold"}};
  ASSERT_TRUE(open_sqlite_catalogue(file_).value()->add(model, {}));
  run(kBeforeSearch + "DELETE FROM migration WHERE version >= 17");
  const auto catalogue = open_sqlite_catalogue(file_).value();
  EXPECT_EQ(catalogue->search({.text = "bronze"}).value().models.size(), 1u);
  EXPECT_EQ(catalogue->facets({.facets = {{"material", "gold"}}}).value().models, 1u);
  EXPECT_EQ(catalogue->harvest({}).value().models.at(0).changed, 1'700'000'000);
}

TEST_F(Migrations, ModelsFromBeforePresentationsAreShownAsInTheirFiles) {
  ModelRecord model{.id = ModelId::generate()};
  ASSERT_TRUE(open_sqlite_catalogue(file_).value()->add(model, {}));
  run(kBeforePresentations + "DELETE FROM migration WHERE version >= 19");
  const auto catalogue = open_sqlite_catalogue(file_).value();
  ModelRecord found = catalogue->find(model.id).value().value();
  EXPECT_TRUE(found.presentation.is_default());
  found.presentation.scale = 25.4;
  ASSERT_TRUE(catalogue->update(found, std::nullopt));
  EXPECT_EQ(catalogue->find(model.id).value()->presentation, found.presentation);
}

TEST_F(Migrations, ModelsFromBeforeNotesHaveNone) {
  const ModelRecord model{.id = ModelId::generate()};
  ASSERT_TRUE(open_sqlite_catalogue(file_).value()->add(model, {}));
  run(kBeforeNotes + "DELETE FROM migration WHERE version >= 20");
  EXPECT_EQ(open_sqlite_catalogue(file_).value()->find(model.id).value()->notes, 0u);
  const auto notes = make_notes(sqlite::open_database(file_).value());
  ASSERT_TRUE(notes->put(model.id, NoteKind::kNotes, {.entries = 2, .text = "[]"}));
  EXPECT_EQ(open_sqlite_catalogue(file_).value()->find(model.id).value()->notes, 2u);
}

TEST_F(Migrations, ContinuesWithTheTablesOfANewerVersionThatAllowsIt) {
  ModelRecord model;
  model.id = ModelId::generate();
  ASSERT_TRUE(open_sqlite_catalogue(file_));
  run("ALTER TABLE model ADD COLUMN of_later TEXT NOT NULL DEFAULT ''");
  run("INSERT INTO migration(version) VALUES (1000); INSERT INTO compatible VALUES (1000, 8)");
  ASSERT_TRUE(open_sqlite_catalogue(file_).value()->add(model, {}));
  EXPECT_TRUE(open_sqlite_catalogue(file_).value()->find(model.id).value());
}

TEST_F(Migrations, ANewerVersionThatDoesNotAllowItIsRefusedAndLeftAlone) {
  ASSERT_TRUE(open_sqlite_catalogue(file_));
  run("INSERT INTO migration(version) VALUES (1000)");
  const auto opened = open_sqlite_catalogue(file_);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(opened.error().message.find("install that version"), std::string::npos);
  run("INSERT INTO compatible VALUES (1000, 1000)");
  EXPECT_FALSE(open_sqlite_catalogue(file_));
}

TEST_F(Migrations, AFileThatIsNoDatabaseIsRefusedByName) {
  std::ofstream(file_) << "this is a text and not a database, however long it may be";
  const auto opened = open_sqlite_catalogue(file_);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kIo);
  EXPECT_NE(opened.error().message.find("catalogue.sqlite"), std::string::npos);
}

TEST_F(Migrations, AMissingFolderIsRefused) {
  EXPECT_FALSE(open_sqlite_catalogue(folder_.path() / "absent" / "catalogue.sqlite"));
}

}  // namespace
}  // namespace vitrine::server
