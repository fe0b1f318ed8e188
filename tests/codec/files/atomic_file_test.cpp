// SPDX-License-Identifier: Apache-2.0
#include "codec/files/atomic_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <fstream>
#include <iterator>

#include "support/temporary_folder.h"

namespace vitrine {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

// Limits the size of files to `bytes`. A write then stops halfway, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    // Ignores SIGXFSZ, so that the write fails with EFBIG instead.
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  sighandler_t handler_;
};

class AtomicFile : public testing::Test {
 protected:
  test::TemporaryFolder folder_;

  Bytes contents(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(in), {});
  }
  std::ptrdiff_t files() {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }
};

TEST_F(AtomicFile, TheFileHoldsTheBytesAndNothingElseStays) {
  const fs::path path = folder_.path() / "out";
  ASSERT_TRUE(write_file_atomically(path, Bytes{1, 2, 3}));
  EXPECT_EQ(contents(path), (Bytes{1, 2, 3}));
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFile, AnOlderFileIsReplaced) {
  const fs::path path = folder_.path() / "out";
  ASSERT_TRUE(write_file_atomically(path, Bytes{1, 2, 3}));
  ASSERT_TRUE(write_file_atomically(path, Bytes{4}));
  EXPECT_EQ(contents(path), Bytes{4});
}

TEST_F(AtomicFile, WhereTheWriteStopsHalfWayTheOlderFileStaysAndNoOther) {
  const fs::path path = folder_.path() / "out";
  ASSERT_TRUE(write_file_atomically(path, Bytes{1, 2, 3}));
  {
    const FileSizeLimit disk(1'000);
    const auto result = write_file_atomically(path, Bytes(5'000));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::kIo);
  }
  EXPECT_EQ(contents(path), (Bytes{1, 2, 3}));
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFile, AMissingFolderIsNamedWithTheNextStep) {
  const auto result = write_file_atomically(folder_.path() / "absent" / "out", Bytes{1});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("absent/out"), std::string::npos);
  EXPECT_NE(result.error().message.find("create the folder"), std::string::npos);
}

TEST_F(AtomicFile, ThatIsCreatedNeverReplacesAnother) {
  const fs::path path = folder_.path() / "out";
  const auto first = create_file_atomically(path, Bytes{1, 2, 3});
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_TRUE(*first);
  const auto second = create_file_atomically(path, Bytes{4});
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_FALSE(*second);
  EXPECT_EQ(contents(path), (Bytes{1, 2, 3}));
  EXPECT_EQ(files(), 1);
  using fs::perms;
  EXPECT_EQ(fs::status(path).permissions() & (perms::owner_write | perms::others_write),
            perms::none);
}

TEST_F(AtomicFile, ThatCannotBeCreatedIsAbsent) {
  const fs::path path = folder_.path() / "out";
  {
    const FileSizeLimit disk(1'000);
    EXPECT_FALSE(create_file_atomically(path, Bytes(5'000)));
  }
  EXPECT_EQ(files(), 0);
  EXPECT_FALSE(create_file_atomically(folder_.path() / "absent" / "out", Bytes{1}));
}

}  // namespace
}  // namespace vitrine
