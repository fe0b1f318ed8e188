// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include "acquisition/session/pgm.h"
#include "scan_test.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

class Reprocess : public ScanTest {
 protected:
  void scan_once(bool keeps_frames) {
    auto scan = this->scan("scan", {.steps = kSteps, .keeps_frames = keeps_frames});
    ASSERT_EQ(run(*scan), ScanState::kDone) << scan->status().error->message;
    surface_ = scan->surface();
  }
  Expected<Reprocessed> again(const ReprocessOptions& options) {
    return reprocess(*ScanFolder::open(path()), calibrations_, options);
  }

  std::shared_ptr<const ScannedSurface> surface_;
};

TEST_F(Reprocess, WithTheSameParametersTheMeshIsTheSame) {
  scan_once(false);
  const auto surface = again({});
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->mesh.positions, surface_->mesh.positions);
  EXPECT_EQ(surface->steps, kSteps);
}

TEST_F(Reprocess, WhatTheStripeShowedIsToldAsTheScanToldItPausedOrNot) {
  world_.object = FakeObject::kTwoSurfaces;
  auto scan = this->scan("scan", {.steps = kSteps, .keeps_frames = true});
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
  EXPECT_EQ(again({.calibration = 2})->stripe, kAll) << "measured again";
}

TEST_F(Reprocess, AnotherSamplingNeedsNoPictures) {
  scan_once(false);
  const auto surface =
      again({.processing = {.sampling = {.method = SamplingMethod::kEquidistant, .window = 10}}});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_LT(surface->mesh.positions.size(), surface_->mesh.positions.size());
}

TEST_F(Reprocess, AnotherWayToFindTheStripeNeedsThePictures) {
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

TEST_F(Reprocess, APictureThatIsGoneIsNamed) {
  scan_once(true);
  std::filesystem::remove(path() / "frames/00003-lit.pgm");
  const auto refused = again({.processing = {.stripe = {.method = StripeMethod::kCentreOfMass}}});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("frames/00003-lit.pgm"));
}

TEST_F(Reprocess, TheJournalOfADoneScanHoldsAllSteps) {
  scan_once(false);
  const auto journal = path() / "profiles";
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) / 2);
  const auto refused = again({});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("of the 12 steps of a completed scan"));
}

TEST_F(Reprocess, OfACancelledScanTheStepsThatThereAreBecomeAMesh) {
  scan_once(false);
  const auto journal = path() / "profiles";
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) / 2);
  ASSERT_TRUE(ScanFolder::open(path())->write_state({.state = ScanState::kCancelled}));
  const auto surface = again({});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_GT(surface->steps, 0);
  EXPECT_LT(surface->steps, kSteps);
}

TEST_F(Reprocess, AFolderThatHasLostItsScanIsRefused) {
  scan_once(false);
  const auto folder = ScanFolder::open(path());
  std::filesystem::remove(path() / "scan.json");
  EXPECT_THAT(reprocess(*folder, calibrations_, {}).error().message, HasSubstr("no scan in"));
}

TEST_F(Reprocess, AnotherCalibrationMovesThePoints) {
  scan_once(true);
  Calibration moved = fake_calibration();
  moved.axis.a = 1;
  ASSERT_EQ(CalibrationStore(calibrations_).add(moved)->number, 2);
  const auto surface = again({.calibration = 2});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_NE(surface->mesh.positions, surface_->mesh.positions);
  moved.camera = "another";
  ASSERT_TRUE(CalibrationStore(calibrations_).add(moved));
  EXPECT_THAT(again({.calibration = 3}).error().message, HasSubstr("is for another camera"));
}

TEST_F(Reprocess, KeptPicturesMeasuredAgainGiveTheSameProfiles) {
  scan_once(true);
  Calibration same = fake_calibration();
  ASSERT_EQ(CalibrationStore(calibrations_).add(same)->number, 2);
  const auto surface = again({.calibration = 2});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.positions, surface_->mesh.positions);
}

TEST_F(Reprocess, TwoSurfacesInARowAreBothKept) {
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

TEST(Pgm, AFrameComesBackAsItWas) {
  const Frame frame{3, 2, {0, 10, 255, 13, 32, 1}};
  EXPECT_EQ(*from_pgm(to_pgm(frame)), frame);
}

TEST(Pgm, CutOrChangedFilesAreRefused) {
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
