// SPDX-License-Identifier: Apache-2.0
// Tests migrations between two folders. tests/server/app/migrate_test.cpp tests those to a bucket
// and a database.
#include "server/backup/migrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/backup/backup.h"
#include "server/backup/checksums.h"
#include "server/backup/repair.h"
#include "server/store/publish.h"
#include "support/damage_object.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class MigrateFolder : public ::testing::Test {
 protected:
  Sha256 add(const std::string& title) {
    const auto bytes = tiny_pmesh("base of " + title, "chunk").bytes;
    EXPECT_TRUE(publish(*from_.store, *from_.catalogue, bytes, {.title = title}));
    return sha256(bytes);
  }
  Expected<MigrationReport> run(const StorageLimits& limits = {}) {
    return migrate(
        from_, to_, [](std::size_t, std::size_t) {}, limits);
  }
  std::size_t copied() const {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / "to/objects"))
      count += entry.is_regular_file() ? 1 : 0;
    return count;
  }

  const TemporaryFolder folder_;
  Installation from_ = open_installation({.folder = folder_.path() / "from"}).value();
  Installation to_ = open_installation({.folder = folder_.path() / "to"}).value();
};

TEST_F(MigrateFolder, DamagedAndMissingFilesAreListedAndTheOthersAreCopied) {
  const Sha256 damaged = add("Damaged"), lost = add("Lost"), unopened = add("Unopened"),
               sound = add("Sound");
  const fs::path tar = folder_.path() / "backup.tar";
  ASSERT_TRUE(back_up(folder_.path() / "from", tar));
  damage_object(folder_.path() / "from", damaged);
  for (const Sha256& name : {lost, unopened})
    ASSERT_TRUE(from_.store->remove(name));
  const fs::path loop = folder_.path() / "from" / object_path(unopened);
  fs::create_symlink(loop, loop);                                          // cannot be opened
  from_ = open_installation({.folder = folder_.path() / "from"}).value();  // it has hashed no file
  const auto done = run();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->models, 4u);
  EXPECT_EQ(done->files, 1u);
  std::vector<std::pair<Sha256, ObjectState>> found;
  for (const DamagedFile& file : done->damaged)
    found.emplace_back(file.file.file, file.state);
  EXPECT_THAT(found, UnorderedElementsAre(std::pair(damaged, ObjectState::kDamaged),
                                          std::pair(unopened, ObjectState::kDamaged),
                                          std::pair(lost, ObjectState::kMissing)));
  EXPECT_TRUE(to_.store->open(sound).value());
  EXPECT_EQ(to_.catalogue->files()->size(), 4u);
  EXPECT_EQ(repair(to_, copies_in_backup(tar))->repaired.size(), 3u);
  EXPECT_TRUE(scrub(*to_.store, *to_.catalogue)->damaged.empty());
}

TEST_F(MigrateFolder, FilesThatOnlyTheDestinationHasIntactAreNotListed) {
  const Sha256 damaged = add("Damaged"), lost = add("Lost");
  ASSERT_TRUE(run());
  damage_object(folder_.path() / "from", damaged);
  ASSERT_TRUE(from_.store->remove(lost));
  // Reopens the source, so that it does not remember which files it has checked already.
  from_ = open_installation({.folder = folder_.path() / "from"}).value();
  const auto done = run();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_TRUE(done->damaged.empty());
  EXPECT_EQ(done->files, 2u);
  EXPECT_GT(done->bytes, 0u);
  damage_object(folder_.path() / "to", damaged);
  EXPECT_EQ(run()->damaged.size(), 1u);
}

TEST_F(MigrateFolder, DamagedAndMissingFilesNeedNoRoom) {
  const Sha256 damaged = add("Damaged"), lost = add("Lost");
  damage_object(folder_.path() / "from", damaged);
  ASSERT_TRUE(from_.store->remove(lost));
  // Reopens the source, so that it does not remember which files it has checked already.
  from_ = open_installation({.folder = folder_.path() / "from"}).value();
  const auto done = run({.disk = {.quota = 1, .reserve = UINT64_MAX}, .uploads = {}});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->damaged.size(), 2u);
}

TEST_F(MigrateFolder, FilesBeyondTheReserveOfTheDestinationAreRefusedBeforeTheFirstIsCopied) {
  add("One");
  add("Two");
  const StorageLimits limits{.disk = {.reserve = UINT64_MAX}, .uploads = {}};
  const auto refused = run(limits);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
  EXPECT_THAT(refused.error().message, HasSubstr("or lower disk-reserve"));
  EXPECT_EQ(copied(), 0u);
  ASSERT_TRUE(run());
  EXPECT_EQ(copied(), 2u);
  EXPECT_TRUE(run(limits)) << "all files are there";
}

TEST_F(MigrateFolder, FilesBeyondTheQuotaOfTheDestinationAreRefusedBeforeTheFirstIsCopied) {
  add("One");
  add("Two");
  std::uint64_t bytes = 0;
  const auto files = from_.catalogue->files().value();
  for (const NamedFile& file : files)
    bytes += file.bytes;
  const auto refused = run({.disk = {.quota = bytes - 1}, .uploads = folder_.path() / "uploads"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
  EXPECT_THAT(refused.error().message, HasSubstr("or raise the setting quota"));
  EXPECT_EQ(copied(), 0u);
  EXPECT_TRUE(run({.disk = {.quota = bytes}, .uploads = folder_.path() / "uploads"}));
}

}  // namespace
}  // namespace vitrine::test
