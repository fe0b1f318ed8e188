// SPDX-License-Identifier: Apache-2.0
// Tests the properties that only objects in files have. The conformance suite tests the properties
// that all stores have in common.
#include "server/store/file_store.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>
#include <utility>

#include "server/store/file_object.h"
#include "support/held_lock.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

class FileStoreTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  FileStore store_ = FileStore::open(folder_.path() / "objects").value();
  const FileStore other_ = FileStore::open(folder_.path() / "objects").value();
  const std::vector<std::uint8_t> bytes_ = test::to_bytes("an object");
  const Sha256 name_ = sha256(bytes_);

  fs::path path() {
    const std::string hex = to_hex(name_);
    return folder_.path() / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex;
  }
};

TEST_F(FileStoreTest, AnObjectIsOneFileNamedByItsHash) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  EXPECT_EQ(fs::file_size(path()), bytes_.size());
  EXPECT_EQ(std::distance(fs::directory_iterator(path().parent_path()), fs::directory_iterator()),
            1);
}

TEST_F(FileStoreTest, AHalfWrittenFileIsNotAnObject) {
  fs::create_directories(path().parent_path());
  std::ofstream(path().parent_path() / ("." + to_hex(name_) + ".0123456789abcdef.part")) << "an o";
  EXPECT_EQ(store_.open(name_).value(), nullptr);
  ASSERT_TRUE(store_.put(name_, bytes_));
  EXPECT_EQ(store_.open(name_).value()->read(0, bytes_.size()).value(), bytes_);
}

TEST_F(FileStoreTest, AnObjectStaysReadableAfterItsFileIsGone) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  const auto object = store_.open(name_).value();
  fs::remove(path());
  EXPECT_EQ(object->read(0, bytes_.size()).value(), bytes_);
}

TEST_F(FileStoreTest, ItsDescriptorServesSendfile) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  const auto object = store_.open(name_).value();
  ASSERT_TRUE(object->descriptor());
  struct stat status {};
  ASSERT_EQ(::fstat(*object->descriptor(), &status), 0);
  EXPECT_EQ(static_cast<std::uint64_t>(status.st_size), bytes_.size());
}

TEST_F(FileStoreTest, AFolderThatCannotBeMadeIsNamed) {
  std::ofstream(folder_.path() / "file") << "x";
  const auto store = FileStore::open(folder_.path() / "file" / "objects");
  ASSERT_FALSE(store);
  EXPECT_NE(store.error().message.find("file/objects"), std::string::npos);
}

TEST_F(FileStoreTest, AnObjectThatCannotBeOpenedIsDamaged) {
  fs::create_directories(path().parent_path());
  fs::create_symlink(path(), path());  // a symbolic link to itself
  EXPECT_EQ(store_.open(name_).error().code, ErrorCode::kState);
  EXPECT_EQ(store_.check(name_, [](std::uint64_t) { return true; }).value(), ObjectState::kDamaged);
  EXPECT_EQ(store_.size_of(name_).value(), 0u);
  EXPECT_TRUE(store_.begin_grace(name_)) << "its model can be removed";
  EXPECT_TRUE(store_.put(name_, bytes_).value());
  EXPECT_EQ(store_.open(name_).value()->read(0, bytes_.size()).value(), bytes_);
}

TEST_F(FileStoreTest, AnObjectIsNotDamagedBecauseTheProcessHasTooManyFilesOpen) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  const auto opened = store_.open(name_);
  const auto checked = store_.check(name_, [](std::uint64_t) { return true; });
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(opened.error().code, ErrorCode::kIo);
  EXPECT_EQ(checked.error().code, ErrorCode::kIo);
}

TEST_F(FileStoreTest, ADamagedObjectIsReplacedWhenPutAgain) {
  EXPECT_TRUE(store_.put(name_, bytes_).value());
  EXPECT_FALSE(store_.put(name_, bytes_).value());
  std::ofstream(path()) << "an 0bject";
  EXPECT_TRUE(store_.put(name_, bytes_).value());
  EXPECT_EQ(store_.open(name_).value()->read(0, bytes_.size()).value(), bytes_);
  fs::resize_file(path(), 3);
  EXPECT_TRUE(store_.put(name_, bytes_).value());
  EXPECT_EQ(store_.open(name_).value()->read(0, bytes_.size()).value(), bytes_);
}

TEST_F(FileStoreTest, ADamagedObjectIsNotOpened) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  ASSERT_TRUE(store_.open(name_));
  std::fstream(path(), std::ios::in | std::ios::out).seekp(3).put('0');
  for (const FileStore* store : {&std::as_const(store_), &other_}) {
    const auto opened = store->open(name_);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::kState);
    EXPECT_NE(opened.error().message.find(to_hex(name_)), std::string::npos);
  }
  ASSERT_TRUE(store_.put(name_, bytes_).value());
  EXPECT_EQ(store_.open(name_).value()->read(0, bytes_.size()).value(), bytes_);
}

TEST_F(FileStoreTest, ACheckTellsIntactDamagedAndMissingObjectsApart) {
  std::uint64_t read = 0;
  const auto check = [&] {
    return store_.check(name_, [&](std::uint64_t bytes) { return read += bytes, true; }).value();
  };
  EXPECT_EQ(check(), ObjectState::kMissing);
  ASSERT_TRUE(store_.put(name_, bytes_));
  EXPECT_EQ(check(), ObjectState::kIntact);
  EXPECT_EQ(read, bytes_.size());
  std::ofstream(path(), std::ios::app) << "s";
  EXPECT_EQ(check(), ObjectState::kDamaged);
  std::ofstream(path()) << "";
  EXPECT_EQ(check(), ObjectState::kDamaged);
}

TEST_F(FileStoreTest, ACheckEndsWhenItsCallerStopsIt) {
  const std::vector<std::uint8_t> long_bytes(3 * kPieceBytes, 'x');
  ASSERT_TRUE(store_.put(sha256(long_bytes), long_bytes));
  int pieces = 0;
  const auto state = store_.check(sha256(long_bytes), [&](std::uint64_t) { return ++pieces < 2; });
  EXPECT_EQ(pieces, 2);
  ASSERT_FALSE(state);
  EXPECT_EQ(state.error().code, ErrorCode::kIo);
}

TEST(CheckedObjects, ForgetsAFileThatChangedAndAllFilesWhenItIsFull) {
  CheckedObjects checked;
  const FileStamp stamp{.inode = 1, .size = 5};
  checked.add(Sha256{1}, stamp);
  EXPECT_TRUE(checked.contains(Sha256{1}, stamp));
  EXPECT_FALSE(checked.contains(Sha256{2}, stamp));
  EXPECT_FALSE(checked.contains(Sha256{1}, FileStamp{.inode = 2, .size = 5}));
  EXPECT_FALSE(
      checked.contains(Sha256{1}, FileStamp{.inode = 1, .size = 5, .changed = {.tv_sec = 1}}));
  for (std::size_t i = 1; i <= CheckedObjects::kMost; ++i)
    checked.add(Sha256{0, static_cast<std::uint8_t>(i >> 16), static_cast<std::uint8_t>(i >> 8),
                       static_cast<std::uint8_t>(i)},
                stamp);
  EXPECT_FALSE(checked.contains(Sha256{1}, stamp));
}

TEST_F(FileStoreTest, ASweepRemovesHalfWrittenFiles) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  const fs::path left = path().parent_path() / ".half.part";
  std::ofstream(left) << "an o";
  EXPECT_EQ(store_.sweep({name_}, std::chrono::hours(1), test::kHeld).value(), 0u);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(path()));
}

TEST_F(FileStoreTest, PuttingAgainOrLosingTheNameRestartsTheGracePeriod) {
  ASSERT_TRUE(store_.put(name_, bytes_));
  const auto grow_old = [&] {
    fs::last_write_time(path(), fs::file_time_type::clock::now() - std::chrono::hours(2));
  };
  grow_old();
  ASSERT_TRUE(store_.put(name_, bytes_));
  EXPECT_EQ(store_.sweep({}, std::chrono::hours(1), test::kHeld).value(), 0u);
  grow_old();
  ASSERT_TRUE(store_.begin_grace(name_));
  EXPECT_EQ(store_.sweep({}, std::chrono::hours(1), test::kHeld).value(), 0u);
  grow_old();
  EXPECT_EQ(store_.sweep({}, std::chrono::hours(1), test::kHeld).value(), 1u);
}

}  // namespace
}  // namespace vitrine::server
