// SPDX-License-Identifier: Apache-2.0
// Tests a rolling upgrade: a daemon of an older release continues to run beside one of this
// release, on a catalogue that the new daemon has migrated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording.h"
#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/sql_catalogue.h"
#include "support/process/postgres_server.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kSearch = "SELECT id, state, created, title";
constexpr const char* kJobs = "SELECT id, kind, state, scanner";
constexpr const char* kNothing = "SELECT 1";
constexpr const char* kVersion = "SELECT coalesce(max(version), 0) FROM migration";

// Removes responses that contain the schema version, because a migration changes it. A recording
// cannot tell whether the old program would accept a newer version.
std::vector<std::string> without_version(std::vector<std::string> answers) {
  std::erase_if(answers, [](const std::string& answer) { return answer.starts_with(kVersion); });
  return answers;
}

class NewDaemon {
 public:
  explicit NewDaemon(const std::string& database)
      : database_(postgres::open_database(database).value().database) {}

  Catalogue& catalogue() { return *catalogue_; }
  JobCatalogue& jobs() { return *jobs_; }

  std::vector<std::string> titles() {
    std::vector<std::string> titles;
    const auto found = catalogue().search({.includes_drafts = true}).value();
    for (const ModelRecord& model : found.models)
      titles.push_back(model.title);
    return titles;
  }

 private:
  std::shared_ptr<sql::Database> database_;
  const std::unique_ptr<Catalogue> catalogue_ = make_catalogue(database_);
  const std::unique_ptr<JobCatalogue> jobs_ = make_jobs(database_);
};

class Upgrade : public testing::TestWithParam<const char*> {
 protected:
  // Applies the statement `change` to the tables of the old release. Returns the responses that the
  // old daemon then gets.
  std::vector<std::string> answers_after(const std::string& change) const {
    const OldDaemon old(new_database());
    old.say(recording_.start);
    EXPECT_THAT(old.say({change, {}}), Not(HasSubstr(kRefused)));
    return old.say(recording_.work);
  }

  // Returns the old daemon's last statement that begins with `beginning` and contains `part`.
  const Said& asked(const std::string& beginning, const std::string& part) const {
    const Said* last = nullptr;
    for (const Transaction& transaction : recording_.work) {
      for (const Said& said : transaction) {
        if (said.sql.starts_with(beginning) && said.sql.find(part) != std::string::npos)
          last = &said;
      }
    }
    if (last == nullptr) throw std::runtime_error("nothing recorded begins with " + beginning);
    return *last;
  }

  const Recording recording_ = read_recording(GetParam());
  const std::string database_ = new_database();
};

TEST_P(Upgrade, AnOldDaemonGetsTheSameResponses) {
  const OldDaemon old(database_);
  old.say(recording_.start);
  NewDaemon successor(database_);
  const auto alone = answers_after(kNothing);
  for (const std::string& answer : alone)
    EXPECT_THAT(answer, Not(HasSubstr(kRefused)));
  const auto beside = without_version(old.say(recording_.work)), expected = without_version(alone);
  ASSERT_EQ(beside.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(beside[i], expected[i]);
}

TEST_P(Upgrade, ANewDaemonReadsTheOldOnesRows) {
  const OldDaemon old(database_);
  old.say(recording_.start);
  NewDaemon successor(database_);
  for (const Transaction& transaction : recording_.work) {
    old.say(std::span(&transaction, 1));
    ASSERT_TRUE(successor.catalogue().search({.includes_drafts = true}));
    ASSERT_TRUE(successor.jobs().unfinished_jobs());
  }
  EXPECT_THAT(successor.titles(), testing::UnorderedElementsAre("Bust", "Second"));
  EXPECT_EQ(successor.jobs().count_jobs().value()[static_cast<std::size_t>(JobState::kDone)], 3u);
  EXPECT_EQ(successor.catalogue().tokens().value().size(), 1u);
}

TEST_P(Upgrade, AnOldDaemonReadsTheNewOnesRows) {
  const OldDaemon old(database_);
  old.say(recording_.start);
  NewDaemon successor(database_);
  old.say(recording_.work);
  ModelRecord model{.id = ModelId::generate()};
  model.title = "Successor's";
  ASSERT_TRUE(successor.catalogue().add(model, {}));
  ASSERT_TRUE(successor.jobs().add({.id = JobId::generate(), .stage = "a new one's"}, {}, {}));
  EXPECT_THAT(old.say(asked(kSearch, "LIMIT")), HasSubstr("Successor's"));
  EXPECT_THAT(old.say(asked(kJobs, "LIMIT")), HasSubstr("a new one's"));
}

TEST_P(Upgrade, AnIncompatibleChangeIsDetected) {
  const auto alone = answers_after(kNothing);
  EXPECT_NE(answers_after("ALTER TABLE job RENAME COLUMN stage TO step"), alone);
  EXPECT_NE(answers_after("ALTER TABLE job ADD COLUMN demand BIGINT NOT NULL"), alone);
  EXPECT_NE(answers_after("ALTER TABLE token DROP COLUMN label"), alone);
  EXPECT_EQ(answers_after("ALTER TABLE job ADD COLUMN more BIGINT NOT NULL DEFAULT 0"), alone);
}

INSTANTIATE_TEST_SUITE_P(Releases, Upgrade, testing::Values("0.1.0"));

}  // namespace
}  // namespace vitrine::test
