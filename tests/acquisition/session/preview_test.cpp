// SPDX-License-Identifier: Apache-2.0
#include "scan_test.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

TEST_F(ScanTest, ThePreviewShowsFrameProfileAndACloudThatGrows) {
  auto scan = this->scan();
  EXPECT_EQ(scan->preview().frame().frame, nullptr);
  std::size_t before = 0;
  world_.meanwhile = [&](const std::string&, int) {
    const std::size_t size = scan->preview().cloud_size();
    EXPECT_GE(size, before);
    before = size;
  };
  ASSERT_EQ(run(*scan), ScanState::kDone);
  const LivePreview& preview = scan->preview();
  const PreviewFrame shown = preview.frame();
  ASSERT_TRUE(shown.frame);
  EXPECT_EQ(shown.frame->width, kFakeWidth);
  EXPECT_EQ(shown.scale, 1);
  EXPECT_EQ(preview.profile().points.size(), static_cast<std::size_t>(kFakeHeight));
  EXPECT_EQ(preview.cloud_size(), static_cast<std::size_t>(kSteps * kFakeHeight));
  const auto all = scan->preview().cloud_from(0);
  const auto rest = scan->preview().cloud_from(100);
  ASSERT_EQ(rest.size(), all.size() - 100);
  EXPECT_EQ(rest.front(), all[100]);
  EXPECT_TRUE(scan->preview().cloud_from(all.size() + 5).empty());
}

TEST(LivePreview, ALargeFrameIsShrunkAndItsThinStripeStays) {
  LivePreview preview(10);
  Frame frame{1300, 1030, std::vector<std::uint8_t>(1300 * 1030)};
  for (int v = 0; v < frame.height; ++v)
    frame.pixels[static_cast<std::size_t>(v) * 1300 + 601] = 200;
  preview.show(frame);
  const PreviewFrame shown = preview.frame();
  EXPECT_EQ(shown.scale, 2);
  EXPECT_EQ(shown.frame->width, 650);
  EXPECT_EQ(shown.frame->height, 515);
  for (int v = 0; v < shown.frame->height; ++v) {
    EXPECT_EQ(shown.frame->row(v)[300], 200);
    EXPECT_EQ(shown.frame->row(v)[299], 0);
  }
}

TEST(LivePreview, ALongScanHasNoLargerCloud) {
  constexpr int kManySteps = 1'000;
  LivePreview preview(kManySteps);
  Profile profile;
  profile.points.resize(1'030);
  for (int i = 0; i < kManySteps; ++i)
    preview.add(profile);
  EXPECT_LE(preview.cloud_size(), acquisition::kCloudPoints);
  EXPECT_GT(preview.cloud_size(), kCloudPoints / 2);
}

TEST_F(ScanTest, AReopenedScanShowsWhatItHas) {
  run(*scan());
  EXPECT_EQ(reopened()->preview().cloud_size(), static_cast<std::size_t>(kSteps * kFakeHeight));
}

}  // namespace
}  // namespace vitrine::test
