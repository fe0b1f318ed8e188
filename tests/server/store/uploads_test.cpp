// SPDX-License-Identifier: Apache-2.0
#include "server/store/uploads.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;
using test::to_bytes;

class UploadsTest : public testing::Test {
 protected:
  static constexpr auto kLate = std::numeric_limits<std::int64_t>::max();
  static TokenId token(std::uint8_t value) {
    std::array<std::uint8_t, 16> bytes{};
    bytes[0] = value;
    return TokenId::from_bytes(bytes);
  }
  std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& file : fs::directory_iterator(folder_.path() / "uploads"))
      ++count;
    return count;
  }

  test::TemporaryFolder folder_;
  Uploads uploads_{folder_.path() / "uploads", {.bytes = 100, .per_token = 2}};
};

TEST_F(UploadsTest, AnotherProcessReadsTheAppendedBytes) {
  const Upload made = uploads_.create(token(1), 6, "filename YQ==").value();
  auto writer = uploads_.writer(made.id, 0).value();
  ASSERT_TRUE(writer.append(to_bytes("abc")));
  EXPECT_EQ(writer.sync().value(), 3u);
  Uploads other(folder_.path() / "uploads", uploads_.limits());
  const Upload found = other.find(made.id).value();
  EXPECT_EQ(found.offset, 3u);
  EXPECT_EQ(found.length, 6u);
  EXPECT_EQ(found.metadata, "filename YQ==");
  EXPECT_EQ(found.token, token(1));
  EXPECT_FALSE(other.open(made.id));
  ASSERT_TRUE(other.writer(made.id, 3).value().append(to_bytes("def")));
  EXPECT_TRUE(uploads_.open(made.id));
}

TEST_F(UploadsTest, OneOfTwoWritersFailsAndNoByteIsWrittenTwice) {
  const Upload made = uploads_.create(token(1), 6, "").value();
  auto first = uploads_.writer(made.id, 0).value(), second = uploads_.writer(made.id, 0).value();
  ASSERT_TRUE(first.append(to_bytes("abc")));
  EXPECT_EQ(second.append(to_bytes("xyz")).error().cause, UploadFault::kMoved);
  EXPECT_EQ(uploads_.find(made.id).value().offset, 3u);
  EXPECT_EQ(uploads_.writer(made.id, 0).error().cause, UploadFault::kMoved);
}

TEST_F(UploadsTest, LimitsAreKept) {
  EXPECT_EQ(uploads_.create(token(1), 101, "").error().cause, UploadFault::kTooLarge);
  const Upload made = uploads_.create(token(1), 2, "").value();
  auto writer = uploads_.writer(made.id, 0).value();
  EXPECT_EQ(writer.append(to_bytes("abc")).error().cause, UploadFault::kTooLarge);
  ASSERT_TRUE(uploads_.create(token(1), 2, ""));
  EXPECT_EQ(uploads_.create(token(1), 2, "").error().cause, UploadFault::kTooMany);
  EXPECT_TRUE(uploads_.create(token(2), 2, ""));
}

TEST_F(UploadsTest, ASweepRemovesExpiredUploadsThatAreNotInUse) {
  const Upload used = uploads_.create(token(1), 2, "").value();
  const Upload left = uploads_.create(token(1), 2, "").value();
  EXPECT_EQ(uploads_.sweep({}, used.expires - 1).value(), 0u);  // no upload has expired yet
  EXPECT_EQ(uploads_.sweep({used.id}, kLate).value(), 1u);
  EXPECT_TRUE(uploads_.find(used.id));
  EXPECT_EQ(uploads_.find(left.id).error().cause, UploadFault::kGone);
  EXPECT_EQ(files(), 2u);
}

TEST_F(UploadsTest, ASweepRemovesRemainsOfInterruptedCalls) {
  const Upload made = uploads_.create(token(1), 2, "").value();
  for (const char* name : {"01arz3ndektsv4rrffq69g5fav.part", ".x.json.part", "notes.txt"})
    std::ofstream(folder_.path() / "uploads" / name) << "left";
  EXPECT_EQ(files(), 5u);
  ASSERT_TRUE(uploads_.sweep({}, 0));
  EXPECT_EQ(files(), 2u);
  EXPECT_TRUE(uploads_.find(made.id));
}

TEST_F(UploadsTest, ASweepKeepsFilesThatItCannotRead) {
  const Upload made = uploads_.create(token(1), 2, "").value();
  const fs::path about = folder_.path() / "uploads" / (made.id.to_string() + ".json");
  fs::rename(about, folder_.path() / "aside");
  fs::create_directory(about);  // a folder can be opened, but not read
  EXPECT_EQ(uploads_.find(made.id).error().cause, UploadFault::kIo);
  EXPECT_EQ(uploads_.open(made.id).error().cause, UploadFault::kIo);
  EXPECT_EQ(uploads_.sweep({}, kLate).value(), 0u);
  fs::remove(about);
  fs::rename(folder_.path() / "aside", about);
  EXPECT_TRUE(uploads_.find(made.id));
  EXPECT_EQ(uploads_.sweep({}, kLate).value(), 1u);
}

TEST_F(UploadsTest, ARemovedUploadIsGone) {
  EXPECT_TRUE(uploads_.list().value().empty());
  const Upload made = uploads_.create(token(1), 2, "").value();
  EXPECT_EQ(uploads_.list().value().size(), 1u);
  ASSERT_TRUE(uploads_.remove(made.id));
  EXPECT_EQ(uploads_.remove(made.id).error().cause, UploadFault::kGone);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace vitrine::server
