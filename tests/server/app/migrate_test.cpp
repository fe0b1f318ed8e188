// SPDX-License-Identifier: Apache-2.0
#include "server/backup/migrate.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "server/app/remote_installation.h"
#include "server/store/publish.h"
#include "support/product_names.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

void nobody_looks(std::size_t, std::size_t) {}

ModelId publish_at(Installation& installation, const std::string& title) {
  const auto pmesh = tiny_pmesh("a base", "a chunk of " + title);
  return publish(*installation.store, *installation.catalogue, pmesh.bytes,
                 {.title = title, .creator = "somebody", .more = {{"date", "1750"}}})
      .value()
      .id;
}

// The contents of a catalogue, as its functions return them.
struct Told {
  std::vector<std::string> models;
  std::vector<TokenId> tokens;
  std::vector<JobRecord> jobs, untold;
  std::vector<ScanEntry> scans;
  std::optional<JobId> once;
  std::uint64_t visits = 0;

  bool operator==(const Told&) const = default;
};

Told told_by(Installation& installation) {
  Told told;
  const auto models = installation.catalogue->search({.includes_drafts = true}).value().models;
  for (const ModelRecord& m : models) {
    const NoteSheet notes = installation.notes->find(m.id, NoteKind::kNotes).value();
    told.models.push_back(m.id.to_string() + m.title + m.creator + m.more.at("date") + notes.text +
                          to_hex(m.file) + std::to_string(m.version) + std::to_string(m.created));
    const auto object = installation.store->open(m.file).value();
    EXPECT_EQ(sha256(object->read(0, object->size()).value()), m.file);
    const auto chunk = parse_header(object->read(0, object->size()).value()).value().base_sha256;
    EXPECT_TRUE(installation.catalogue->find_chunk(chunk).value());
  }
  const auto tokens = installation.catalogue->tokens().value();
  for (const TokenRecord& token : tokens)
    told.tokens.push_back(token.id);
  told.jobs = installation.jobs->jobs({}).value();
  told.untold = installation.jobs->unnotified_jobs().value();
  told.scans = installation.jobs->scans({}).value();
  if (const auto earlier = installation.jobs->find_key("a key").value()) told.once = earlier->job;
  const std::chrono::sys_days day{};
  const auto visits = installation.visits->by_day({day, day}, 10).value();
  for (const DayVisits& row : visits)
    told.visits += row.of.counts.visits;
  return told;
}

class Migrate : public testing::Test {
 protected:
  void fill() {
    const ModelId vase = publish_at(folder_, "vase");
    ASSERT_TRUE(folder_.visits->add({{{vase, {}}, {.visits = 5}}}));
    ASSERT_TRUE(folder_.notes->put(vase, NoteKind::kNotes, {.entries = 3, .text = "[1,2,3]"}));
    publish_at(folder_, "bowl");
    const JobRecord told{.id = JobId::generate(), .state = JobState::kDone, .webhook = "http://a/"};
    const JobRecord untold{
        .id = JobId::generate(), .state = JobState::kFailed, .error = "no", .webhook = "http://b/"};
    const ScanEntry scan{.id = ScanId::generate(),
                         .job = told.id,
                         .title = "a scan",
                         .steps = 720,
                         .rows = ScannedRows{.25, .5, 0}};
    ASSERT_TRUE(folder_.jobs->add(told, scan, IdempotencyKey{"a key", sha256({})}));
    ASSERT_TRUE(folder_.jobs->set_notified(told.id));
    ASSERT_TRUE(folder_.jobs->add(untold, {}, {}));
    ASSERT_TRUE(folder_.catalogue->add_token(
        {.id = TokenId::generate(), .role = Role::kAdmin, .hash = sha256({}), .label = "l"}));
  }

  const TemporaryFolder root_;
  const RemoteInstallation place_;
  Installation folder_ = open_installation({.folder = root_.path() / "a"}).value();
  Installation remote_ = open_installation(place_.place()).value();
};

TEST_F(Migrate, AnInstallationIsTheSameAfterMovingThereAndBack) {
  fill();
  const auto moved = migrate(folder_, remote_, nobody_looks);
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_EQ(moved->models, 2u);
  EXPECT_EQ(moved->files, 2u);
  EXPECT_EQ(told_by(remote_).visits, 5u);
  EXPECT_EQ(told_by(remote_), told_by(folder_));
  Installation back = open_installation({.folder = root_.path() / "b"}).value();
  ASSERT_TRUE(migrate(remote_, back, nobody_looks));
  EXPECT_EQ(told_by(back), told_by(folder_));
}

TEST_F(Migrate, WhatWasInterruptedShowsNothingAndIsDoneAgain) {
  fill();
  const auto stop = [](std::size_t, std::size_t) { throw std::runtime_error("stopped"); };
  EXPECT_THROW(migrate(folder_, remote_, stop), std::runtime_error);
  EXPECT_EQ(told_by(remote_), Told{});
  ASSERT_TRUE(migrate(folder_, remote_, nobody_looks));
  ASSERT_TRUE(migrate(folder_, remote_, nobody_looks));
  EXPECT_EQ(told_by(remote_), told_by(folder_));
}

TEST_F(Migrate, TwoInstallationsAreNotMixed) {
  fill();
  publish_at(remote_, "another");
  const auto before = told_by(remote_);
  const auto refused = migrate(folder_, remote_, nobody_looks);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kState);
  EXPECT_EQ(told_by(remote_), before);
}

TEST_F(Migrate, APlaceIsNotMigratedToItself) {
  Installation same = open_installation(place_.place()).value();
  EXPECT_FALSE(migrate(remote_, same, nobody_looks));
}

TEST_F(Migrate, TheCatalogueCanMoveAlone) {
  fill();
  InstallationPlace place = place_.place();
  place.folder = folder_.place.folder;
  place.store = {};
  Installation beside = open_installation(place).value();
  ASSERT_TRUE(migrate(folder_, beside, nobody_looks));
  EXPECT_EQ(told_by(beside), told_by(folder_));
}

}  // namespace
}  // namespace vitrine::test
