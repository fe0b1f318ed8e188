// SPDX-License-Identifier: Apache-2.0
// Tests that `restore` and `repair` fail before they write if the disk has too little room.
#include "server/store/disk_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/backup/backup.h"
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

class DiskSpace : public ::testing::Test {
 protected:
  DiskSpace() {
    EXPECT_TRUE(publish(*installation_.store, *installation_.catalogue, file_, {.title = "One"}));
    EXPECT_TRUE(back_up(data_, tar_));
  }

  const TemporaryFolder folder_;
  const fs::path data_ = folder_.path() / "data", tar_ = folder_.path() / "backup.tar",
                 again_ = folder_.path() / "again";
  const std::vector<std::uint8_t> file_ = tiny_pmesh("a base", "a chunk").bytes;
  Installation installation_ = open_installation({.folder = data_}).value();
};

TEST_F(DiskSpace, ABackupLargerThanTheFreeSpaceIsNotRestored) {
  const auto size = fs::file_size(tar_);
  // The file becomes longer, but has no blocks on the disk for its new part.
  fs::resize_file(tar_, free_space(folder_.path()) + (std::uint64_t{1} << 30));
  const auto refused = restore(tar_, again_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
  EXPECT_THAT(refused.error().message, HasSubstr("more bytes, or choose another disk"));
  EXPECT_FALSE(fs::exists(again_));
  fs::resize_file(tar_, size);
  EXPECT_TRUE(restore(tar_, again_));
}

TEST_F(DiskSpace, AMissingObjectIsPutBackIfTheReserveStaysFree) {
  ASSERT_TRUE(installation_.store->remove(sha256(file_)));
  const auto refused = repair(installation_, copies_in_backup(tar_), UINT64_MAX);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
  EXPECT_THAT(refused.error().message,
              HasSubstr("to free " + std::to_string(file_.size()) + " more bytes"));
  EXPECT_EQ(installation_.store->size_of(sha256(file_)).value(), std::nullopt);
  EXPECT_EQ(repair(installation_, copies_in_backup(tar_))->repaired.size(), 1u);
}

TEST_F(DiskSpace, ADamagedObjectOfTheSameSizeNeedsNoRoom) {
  damage_object(data_, sha256(file_));
  EXPECT_EQ(repair(installation_, copies_in_backup(tar_), UINT64_MAX)->repaired.size(), 1u);
}

}  // namespace
}  // namespace vitrine::test
