// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <fstream>

#include "acquisition/session/profile_journal.h"
#include "codec/core/byte_cursor.h"
#include "codec/core/sha256.h"
#include "codec/files/read_file.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

class Journal : public testing::Test {
 protected:
  // Writes two records for each step i: that the table turns to i, and a profile with i points.
  // Stores the file's size after each record in ends_.
  void write(int profiles) {
    JournalContents contents;
    auto journal = ProfileJournal::open(path_, contents);
    ASSERT_TRUE(journal);
    for (int i = 0; i < profiles; ++i) {
      ASSERT_TRUE(journal->note_turn(i));
      ends_.push_back(std::filesystem::file_size(path_));
      ASSERT_TRUE(journal->append(profile(i), stripe(i)));
      ends_.push_back(std::filesystem::file_size(path_));
    }
  }
  static Profile profile(int points) {
    Profile profile{.theta = 0.1 * points, .points = {}};
    for (int i = 0; i < points; ++i)
      profile.points.push_back(
          {{1.0 / (i + 3), -0.1 * i, 0.3 * i}, i / 2, i % 2 ? kSecond : kDouble});
    return profile;
  }
  static StripeCount stripe(std::uint64_t i) {
    return {1, 3 * i, 2 * i, i, 5'000'000'000 + i, 7 * i};
  }
  std::vector<std::uint8_t> bytes() const { return *read_file(path_, 1 << 20); }

  static void expect_profiles(const JournalContents& contents, std::size_t count) {
    const auto& [profiles, stripes, stands_at, given_up_at, size] = contents;
    ASSERT_EQ(profiles.size(), count);
    ASSERT_EQ(stripes.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(stripes[i], stripe(i));
      const Profile wanted = profile(static_cast<int>(i));
      EXPECT_EQ(profiles[i].theta, wanted.theta);
      ASSERT_EQ(profiles[i].points.size(), wanted.points.size());
      for (std::size_t j = 0; j < wanted.points.size(); ++j) {
        EXPECT_EQ(profiles[i].points[j].at.rho, wanted.points[j].at.rho);
        EXPECT_EQ(profiles[i].points[j].at.lateral, wanted.points[j].at.lateral);
        EXPECT_EQ(profiles[i].points[j].at.z, wanted.points[j].at.z);
        EXPECT_EQ(profiles[i].points[j].row, wanted.points[j].row);
        EXPECT_EQ(profiles[i].points[j].flags, wanted.points[j].flags);
      }
    }
  }
  // Returns the number of complete records in the first `size` bytes. Records of turns and profiles
  // alternate.
  std::size_t whole_records(std::size_t size) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(ends_, [&](std::uintmax_t end) { return end <= size; }));
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "profiles";
  std::vector<std::uintmax_t> ends_;
};

TEST_F(Journal, CutAtAnyByteItHoldsAllWholeProfiles) {
  write(6);
  const auto file = bytes();
  for (std::size_t size = 0; size <= file.size(); ++size) {
    const JournalContents contents = read_journal(std::span(file).first(size));
    const std::size_t records = whole_records(size);
    expect_profiles(contents, records / 2);
    EXPECT_EQ(contents.bytes, records == 0 ? 0 : ends_[records - 1]);
    EXPECT_EQ(contents.stands_at.has_value(), records > 0);
    if (records > 0) {
      EXPECT_EQ(*contents.stands_at, static_cast<int>((records - 1) / 2));
    }
  }
}

TEST_F(Journal, WhatIsGivenUpIsGoneAndWhatFollowsTakesItsPlace) {
  write(5);
  JournalContents contents;
  auto journal = ProfileJournal::open(path_, contents);
  ASSERT_TRUE(journal);
  EXPECT_EQ(contents.given_up_at, 0);
  ASSERT_TRUE(journal->give_up(2, 5));
  contents = read_journal(bytes());
  expect_profiles(contents, 2);
  EXPECT_EQ(contents.given_up_at, 5);
  EXPECT_EQ(contents.stands_at, 4) << "the table has not moved";
  EXPECT_EQ(contents.bytes, bytes().size());
  ASSERT_TRUE(journal->append(profile(2), stripe(2)));
  expect_profiles(read_journal(bytes()), 3);
}

TEST_F(Journal, AProfileOfAnOlderVersionHasNoCountsAndIsRead) {
  constexpr std::uint32_t kPoints = 3, kPointBytes = 29;
  ByteWriter out;
  out.u32(1), out.u32(8 + kPoints * kPointBytes);
  out.f64(0.5);
  out.bytes(std::vector<std::uint8_t>(kPoints * kPointBytes, 7));
  std::vector<std::uint8_t> file = out.take();
  const Sha256 digest = sha256(file);
  file.insert(file.end(), digest.begin(), digest.begin() + 8);
  const JournalContents contents = read_journal(file);
  ASSERT_EQ(contents.profiles.size(), 1u);
  EXPECT_EQ(contents.profiles[0].theta, 0.5);
  EXPECT_EQ(contents.profiles[0].points.size(), kPoints);
  EXPECT_EQ(contents.profiles[0].points[2].row, 0x07070707);
  EXPECT_EQ(contents.stripes[0], (StripeCount{.frames = 1, .rows = kPoints}));
  EXPECT_EQ(contents.bytes, file.size());
}

TEST_F(Journal, DamageInAnyByteCostsWhatFollowsItAndNoMore) {
  write(4);
  const auto file = bytes();
  for (std::size_t at = 0; at < file.size(); ++at) {
    auto damaged = file;
    damaged[at] ^= 0x10;
    expect_profiles(read_journal(damaged), whole_records(at) / 2);
  }
}

TEST_F(Journal, CutAtAnyByteItIsGoneOnWith) {
  write(3);
  const auto file = bytes();
  for (std::size_t size = 0; size < file.size(); ++size) {
    std::filesystem::resize_file(path_, size);
    JournalContents contents;
    auto journal = ProfileJournal::open(path_, contents);
    ASSERT_TRUE(journal);
    for (int i = static_cast<int>(contents.profiles.size()); i < 5; ++i)
      ASSERT_TRUE(journal->append(profile(i), stripe(i)));
    expect_profiles(read_journal(bytes()), 5);
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.data()),
               static_cast<std::streamsize>(file.size()));
  }
}

}  // namespace
}  // namespace vitrine::test
