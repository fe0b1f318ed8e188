// SPDX-License-Identifier: Apache-2.0
// Tests `vitrine reprocess` on a scan made by a simulated scanner.
#include <gmock/gmock.h>

#include "acquisition/calibration/calibration_store.h"
#include "acquisition/session/fake_scanner.h"
#include "acquisition/session/scan.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

class ReprocessCommand : public VitrineCommand {
 protected:
  ReprocessCommand() {
    write("rig.json", R"({"camera": {"serial": "fake-1"}, "calibrations": "calibrations",
      "board": {"dialect": "horus", "vendor": "0x2341", "product": "0x0043", "serial": "absent"},
      "target": {"squares_x": 9, "squares_y": 14, "square_mm": 8, "marker_mm": 6,
                 "dictionary": "DICT_4X4_100"}})");
    EXPECT_TRUE(CalibrationStore(path("calibrations")).add(fake_calibration()));
  }

  void scan(bool keeps_frames, FakeObject object = FakeObject::kColumn) {
    FakeWorld world;
    world.object = object;
    const auto scan = Scan::create(fake_scanner(world, path("calibrations")),
                                   {.steps = 12, .keeps_frames = keeps_frames}, path("scan"));
    ASSERT_TRUE(scan) << scan.error().message;
    ASSERT_TRUE((*scan)->resume());
    ASSERT_EQ((*scan)->wait(std::chrono::hours(1)).state, ScanState::kDone);
  }
  std::vector<std::string> words(const std::string& out,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"reprocess",      path("scan"), "--config",
                                    path("rig.json"), "-o",         path(out)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(ReprocessCommand, TheScansOwnParametersAreTheDefault) {
  scan(false, FakeObject::kTwoSurfaces);
  const auto same = vitrine_json(words("same.ply")),
             said = vitrine_json(words("said.ply", {"--sampling", "adaptive", "--length", "5"}));
  EXPECT_EQ(same["calibration"], 1);
  EXPECT_EQ(same["steps"], 12);
  EXPECT_EQ(same["steps_done"], 12);
  EXPECT_EQ(same["rows"], nlohmann::json::parse(R"({"empty":0.0,"saturated":0.0,"doubled":0.5})"));
  EXPECT_EQ(read("same.ply"), read("said.ply"));
  const auto coarse = vitrine_json(words("coarse.ply", {"--length", "20"}));
  EXPECT_LT(coarse["vertices"], same["vertices"]);
}

TEST_F(ReprocessCommand, TheSummaryReportsTheRows) {
  scan(false, FakeObject::kTwoSurfaces);
  EXPECT_THAT(vitrine(words("out.ply")).output,
              HasSubstr("calibration 1; 0.0 % of all rows show no stripe, 0.0 % of the others are "
                        "saturated, 50.0 % show two\n"));
}

TEST_F(ReprocessCommand, AnotherStripeOrCalibrationIsMeasuredInThePictures) {
  scan(true);
  Calibration moved = fake_calibration();
  moved.axis.a = 1;
  ASSERT_TRUE(CalibrationStore(path("calibrations")).add(moved));
  vitrine_json(words("same.ply"));
  vitrine_json(words("mass.ply", {"--stripe", "centre-of-mass"}));
  EXPECT_NE(read("mass.ply"), read("same.ply"));
  EXPECT_EQ(vitrine_json(words("moved.ply", {"--calibration", "2"}))["calibration"], 2);
  EXPECT_NE(read("moved.ply"), read("same.ply"));
}

TEST_F(ReprocessCommand, AnOptionThatNeedsThePicturesSaysSoAndWritesNothing) {
  scan(false);
  const ProgramResult stripe = vitrine(words("out.ply", {"--stripe", "blais-rioux"}));
  expect_fault(stripe, 1);
  EXPECT_THAT(stripe.errors, HasSubstr("another stripe method needs the pictures"));
  expect_fault(vitrine(words("out.ply", {"--calibration", "2"})), 1);
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
}

TEST_F(ReprocessCommand, AnIncompleteScanIsReportedAsSuch) {
  scan(false);
  const auto journal = path("scan/profiles");
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) / 2);
  expect_fault(vitrine(words("out.ply")), 1);
  write("scan/state.json", R"({"state": "cancelled"})");
  const ProgramResult part = vitrine(words("out.ply"));
  EXPECT_EQ(part.exit_code, 0) << part.errors;
  EXPECT_THAT(part.errors, HasSubstr("of 12: the mesh contains only these steps"));
  EXPECT_THAT(part.output, HasSubstr("points in 5 of 12 steps"));
}

TEST_F(ReprocessCommand, AMeshThatExistsIsNotReplacedWithoutForce) {
  scan(false);
  write("out.ply", "mine");
  const ProgramResult refused = vitrine(words("out.ply"));
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, HasSubstr("out.ply exists; choose another name, or replace it with "
                                        "--force"));
  EXPECT_EQ(read("out.ply"), "mine");
  vitrine_json(words("out.ply", {"--force"}));
  EXPECT_THAT(read("out.ply"), testing::StartsWith("ply\n"));
}

TEST_F(ReprocessCommand, WrongUsageIsReported) {
  scan(false);
  const std::string scan_folder = path("scan"), rig = path("rig.json"), out = path("out.ply");
  const std::vector<std::vector<std::string>> lines = {
      {"reprocess", "--config", rig, "-o", out},   {"reprocess", scan_folder, "-o", out},
      {"reprocess", scan_folder, "--config", rig}, words("out.xyz"),
      words("out.ply", {"--calibration", "0"}),    words("out.ply", {"--sampling", "best"})};
  for (const auto& line : lines)
    EXPECT_EQ(vitrine(line).exit_code, 2) << testing::PrintToString(line);
  expect_fault(vitrine({"reprocess", path("absent"), "--config", rig, "-o", out}), 1);
}

}  // namespace
}  // namespace vitrine::test
