// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include "acquisition/session/pgm.h"
#include "scan_test.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

class Reprocess : public ScanTest {
 protected:
  void scan_once(bool keep_frames) {
    auto scan = this->scan("scan", {.steps = kSteps, .keep_frames = keep_frames});
    ASSERT_EQ(run(*scan), ScanState::kDone) << scan->status().error->message;
    surface_ = scan->surface();
  }
  Expected<Reprocessed> again(const ReprocessOptions& options) {
    return reprocess(*ScanFolder::open(path()), calibrations_, options);
  }

  std::shared_ptr<const ScannedSurface> surface_;
};

TEST_F(Reprocess, with_the_same_parameters_the_mesh_is_the_same) {
  scan_once(false);
  const auto surface = again({});
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->mesh.positions, surface_->mesh.positions);
  EXPECT_EQ(surface->steps, kSteps);
}

TEST_F(Reprocess, what_the_stripe_showed_is_told_as_the_scan_told_it_paused_or_not) {
  world_.object = FakeObject::kTwoSurfaces;
  auto scan = this->scan("scan", {.steps = kSteps, .keep_frames = true});
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call == "turn" && count == 5) (void)scan->pause();
  };
  ASSERT_EQ(run(*scan), ScanState::kPaused);
  ASSERT_EQ(run(*scan), ScanState::kDone);
  constexpr StripeCount kAll{.frames = kSteps,
                             .rows = kSteps * kFakeHeight,
                             .saturated = 0,
                             .doubled = kSteps * (kFakeHeight - kFakeOtherRow),
                             .pixels = 2 * kSteps * kFakeWidth * kFakeHeight};
  EXPECT_EQ(scan->status().stripe, kAll);
  EXPECT_EQ(reopened()->status().stripe, kAll);
  EXPECT_EQ(again({})->stripe, kAll);
  ASSERT_TRUE(CalibrationStore(calibrations_).add(fake_calibration()));
  EXPECT_EQ(again({.calibration = 2})->stripe, kAll) << "measured anew";
}

TEST_F(Reprocess, another_sampling_needs_no_pictures) {
  scan_once(false);
  const auto surface =
      again({.processing = {.sampling = {.method = SamplingMethod::kEquidistant, .window = 10}}});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_LT(surface->mesh.positions.size(), surface_->mesh.positions.size());
}

TEST_F(Reprocess, another_way_to_find_the_stripe_needs_the_pictures) {
  const ReprocessOptions other{.processing = {.stripe = {.method = StripeMethod::kCentreOfMass}}};
  scan_once(false);
  const auto refused = again(other);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("were not kept"));
  std::filesystem::remove_all(path());
  scan_once(true);
  const auto surface = again(other);
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_NE(surface->mesh.positions, surface_->mesh.positions);
}

TEST_F(Reprocess, a_picture_that_is_gone_is_named) {
  scan_once(true);
  std::filesystem::remove(path() / "frames/00003-lit.pgm");
  const auto refused = again({.processing = {.stripe = {.method = StripeMethod::kCentreOfMass}}});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("frames/00003-lit.pgm"));
}

TEST_F(Reprocess, the_journal_of_a_done_scan_holds_all_steps) {
  scan_once(false);
  const auto journal = path() / "profiles";
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) / 2);
  const auto refused = again({});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("of the 12 steps of a scan that is done"));
}

TEST_F(Reprocess, of_a_cancelled_scan_the_steps_that_there_are_become_a_mesh) {
  scan_once(false);
  const auto journal = path() / "profiles";
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) / 2);
  ASSERT_TRUE(ScanFolder::open(path())->write_state({.state = ScanState::kCancelled}));
  const auto surface = again({});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_GT(surface->steps, 0);
  EXPECT_LT(surface->steps, kSteps);
}

TEST_F(Reprocess, a_folder_that_has_lost_its_scan_is_refused) {
  scan_once(false);
  const auto folder = ScanFolder::open(path());
  std::filesystem::remove(path() / "scan.json");
  EXPECT_THAT(reprocess(*folder, calibrations_, {}).error().message, HasSubstr("no scan in"));
}

TEST_F(Reprocess, another_calibration_moves_the_points) {
  scan_once(true);
  Calibration moved = fake_calibration();
  moved.axis.a = 1;
  ASSERT_EQ(CalibrationStore(calibrations_).add(moved)->number, 2);
  const auto surface = again({.calibration = 2});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_NE(surface->mesh.positions, surface_->mesh.positions);
  moved.camera = "another";
  ASSERT_TRUE(CalibrationStore(calibrations_).add(moved));
  EXPECT_THAT(again({.calibration = 3}).error().message, HasSubstr("is not of the camera"));
}

TEST_F(Reprocess, kept_pictures_measured_again_give_the_same_profiles) {
  scan_once(true);
  Calibration same = fake_calibration();
  ASSERT_EQ(CalibrationStore(calibrations_).add(same)->number, 2);
  const auto surface = again({.calibration = 2});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.positions, surface_->mesh.positions);
}

TEST_F(Reprocess, two_surfaces_in_a_row_are_both_kept) {
  world_.object = FakeObject::kTwoSurfaces;
  scan_once(true);
  const auto scan = ScanFolder::open(path())->measured();
  ASSERT_TRUE(scan);
  for (const Profile& profile : scan->profiles) {
    const auto second = std::ranges::count_if(
        profile.points, [](const ProfilePoint& p) { return (p.flags & kSecond) != 0; });
    EXPECT_EQ(second, kFakeHeight - kFakeOtherRow);
  }
  const auto surface = again({});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.positions, surface_->mesh.positions);
}

TEST(Pgm, a_frame_comes_back_as_it_was) {
  const Frame frame{3, 2, {0, 10, 255, 13, 32, 1}};
  EXPECT_EQ(*from_pgm(to_pgm(frame)), frame);
}

TEST(Pgm, cut_or_changed_files_are_refused) {
  const auto file = to_pgm({3, 2, {0, 10, 255, 13, 32, 1}});
  for (std::size_t size = 0; size < file.size(); ++size)
    EXPECT_FALSE(from_pgm(std::span(file).first(size)));
  for (std::size_t i = 0; i < file.size() - 6; ++i) {
    auto changed = file;
    changed[i] ^= 0x44;
    EXPECT_FALSE(from_pgm(changed)) << i;
  }
  const std::string huge = "P5\n32768 32768\n255\n";
  EXPECT_FALSE(
      from_pgm(std::span(reinterpret_cast<const std::uint8_t*>(huge.data()), huge.size())));
}

}  // namespace
}  // namespace vitrine::test
