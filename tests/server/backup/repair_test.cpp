// SPDX-License-Identifier: Apache-2.0
#include "server/backup/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/backup/backup.h"
#include "server/backup/checksums.h"
#include "server/store/publish.h"
#include "server/store/published_model.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RepairTest : public ::testing::Test {
 protected:
  ModelId add(Installation& to, const std::string& title) const {
    return publish(*to.store, *to.catalogue, tiny_pmesh("base of " + title, "chunk").bytes,
                   {.title = title})
        .value()
        .id;
  }
  fs::path object(const fs::path& data, const ModelId& id) {
    return data / object_path(here_.catalogue->find(id).value()->file);
  }
  static void damage(const fs::path& file) {
    std::fstream(file, std::ios::in | std::ios::out).seekp(-1, std::ios::end).put('!');
  }

  const TemporaryFolder folder_;
  const fs::path data_ = folder_.path() / "data", other_ = folder_.path() / "other",
                 tar_ = folder_.path() / "backup.tar";
  Installation here_ = open_installation({.folder = data_}).value();
};

TEST_F(RepairTest, DamagedAndMissingObjectsComeBackFromABackup) {
  const ModelId damaged = add(here_, "Damaged"), lost = add(here_, "Lost"),
                unopened = add(here_, "Unopened");
  add(here_, "Sound");
  ASSERT_TRUE(back_up(data_, tar_));
  PublishedModels daemon(*here_.store, *here_.catalogue, std::chrono::milliseconds(0));
  damage(object(data_, damaged));
  for (const ModelId& id : {lost, unopened})
    fs::remove(object(data_, id));
  fs::create_symlink(object(data_, unopened), object(data_, unopened));  // cannot be opened
  EXPECT_FALSE(daemon.find(damaged));
  EXPECT_FALSE(daemon.find(lost));
  EXPECT_FALSE(daemon.find(unopened));
  const auto done = repair(here_, copies_in_backup(tar_));
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->objects, 4u);
  EXPECT_EQ(done->repaired.size(), 3u);
  EXPECT_TRUE(done->damaged.empty());
  EXPECT_TRUE(daemon.find(damaged)) << "a daemon notices the repair";
  EXPECT_TRUE(daemon.find(lost));
  EXPECT_TRUE(daemon.find(unopened));
  EXPECT_TRUE(scrub(*here_.store, *here_.catalogue)->damaged.empty());
}

TEST_F(RepairTest, AnObjectComesBackFromAnotherInstallationUnlessItIsDamagedThereToo) {
  Installation there = open_installation({.folder = other_}).value();
  const ModelId one = add(here_, "One"), two = add(here_, "Two"), three = add(here_, "Three");
  add(there, "One");
  add(there, "Two");
  for (const ModelId& id : {one, two, three})
    damage(object(data_, id));
  damage(object(other_, two));
  const auto done = repair(here_, copies_in_store(*there.store));
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(done->repaired.size(), 1u);
  EXPECT_EQ(done->repaired[0].file.model, one);
  EXPECT_EQ(done->damaged.size(), 2u);
}

TEST_F(RepairTest, ADamagedCopyInABackupIsNotUsed) {
  const ModelId id = add(here_, "One");
  ASSERT_TRUE(back_up(data_, tar_));
  std::ifstream in(tar_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::fstream(tar_, std::ios::in | std::ios::out)
      .seekp(static_cast<std::streamoff>(bytes.find("base of One")))
      .put('!');
  damage(object(data_, id));
  const auto done = repair(here_, copies_in_backup(tar_));
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_TRUE(done->repaired.empty());
  EXPECT_EQ(done->damaged.size(), 1u);
}

TEST_F(RepairTest, AnIntactInstallationStaysAsItIs) {
  const ModelId id = add(here_, "One");
  ASSERT_TRUE(back_up(data_, tar_));
  const auto before = here_.catalogue->revision().value();
  const auto done = repair(here_, copies_in_backup(tar_));
  ASSERT_TRUE(done);
  EXPECT_EQ(done->objects, 1u);
  EXPECT_EQ(here_.catalogue->revision().value(), before);
  damage(object(data_, id));
  const auto none = repair(here_, copies_in_backup(folder_.path() / "none.tar"));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("none.tar"));
}

}  // namespace
}  // namespace vitrine::test
