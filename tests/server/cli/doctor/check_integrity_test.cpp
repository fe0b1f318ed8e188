// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/store/publish.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using testing::HasSubstr;

class CheckIntegrity : public testing::Test {
 protected:
  Sha256 add(const std::string& title) {
    const auto file = test::tiny_pmesh("base of " + title, "chunk").bytes;
    EXPECT_TRUE(publish(*in_.store, *in_.catalogue, file, {.title = title}));
    return sha256(file);
  }
  void damage(const Sha256& file) {
    const std::string hex = to_hex(file);
    std::fstream(folder_.path() / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex,
                 std::ios::in | std::ios::out)
        .seekp(-1, std::ios::end)
        .put('!');
  }

  const test::TemporaryFolder folder_;
  const InstallationPlace place_{.folder = folder_.path()};
  Installation in_ = open_installation(place_).value();
};

TEST_F(CheckIntegrity, EveryDamagedObjectIsAFinding) {
  const Sha256 one = add("one"), two = add("two");
  add("three");
  const Findings intact = check_integrity(place_);
  ASSERT_EQ(intact.size(), 2u);
  EXPECT_EQ(intact[0].verdict, Verdict::kOk) << intact[0].detail;
  EXPECT_EQ(intact[1].verdict, Verdict::kOk) << intact[1].detail;
  EXPECT_THAT(intact[1].detail, HasSubstr("3 objects"));
  damage(one);
  damage(two);
  const Findings damaged = check_integrity(place_);
  ASSERT_EQ(damaged.size(), 3u);
  std::string text;
  for (const Finding& finding : damaged)
    text += finding.detail;
  EXPECT_THAT(text, HasSubstr(to_hex(one)));
  EXPECT_THAT(text, HasSubstr(to_hex(two)));
  EXPECT_EQ(damaged[1].verdict, Verdict::kFail);
  EXPECT_THAT(damaged[1].advice, HasSubstr("vitrine repair"));
}

TEST_F(CheckIntegrity, ADamagedCatalogueIsAFinding) {
  add("one");
  in_ = Installation{};  // closes the catalogue, which empties its write-ahead log
  std::fstream(folder_.path() / kCatalogueFile, std::ios::in | std::ios::out)
      .seekp(4096)
      .write(std::string(64, '\x7f').c_str(), 64);
  const Findings damaged = check_integrity(place_);
  ASSERT_FALSE(damaged.empty());
  EXPECT_EQ(damaged[0].check, "integrity");
  EXPECT_EQ(damaged[0].verdict, Verdict::kFail);
}

}  // namespace
}  // namespace vitrine::server
