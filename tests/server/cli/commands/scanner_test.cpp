// SPDX-License-Identifier: Apache-2.0
// Tests the errors of `calibrate` and `scan` without a scanner. tests/acquisition/rig runs these
// commands on the simulated scanner.
#include <gmock/gmock.h>

#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ScannerCommands : public VitrineCommand {
 protected:
  // Writes the configuration of a scanner that does not exist, and returns its path.
  std::string config(const std::string& camera = R"({"address": "127.0.0.2"})") const {
    return write("rig.json", R"({"camera": )" + camera + R"(,
      "board": {"dialect": "horus", "vendor": "0x2341", "product": "0x0043", "serial": "absent"},
      "target": {"squares_x": 9, "squares_y": 14, "square_mm": 8, "marker_mm": 6,
                 "dictionary": "DICT_4X4_100"}})");
  }
};

TEST_F(ScannerCommands, WrongUsageIsExitCode2) {
  const std::string rig = config(), out = path("out.ply");
  const std::vector<std::vector<std::string>> lines = {
      {"calibrate"},
      {"calibrate", "--config", rig, "--degree", "6"},
      {"calibrate", "--config", rig, "extra"},
      {"calibrate", "--config", rig, "--correspondences", rig},
      {"calibrate", "--config", rig, "--axis", rig},
      {"scan", "-o", out},
      {"scan", "--config", rig},
      {"scan", "--config", rig, "-o", path("out.xyz")},
      {"scan", "--config", rig, "-o", out, "--steps", "7"},
      {"scan", "--config", rig, "-o", out, "--steps", "36001"},
      {"scan", "--config", rig, "-o", out, "--calibration", "0"},
      {"scan", "--config", rig, "-o", out, "--length", "6"},
      {"scan", "--config", rig, "-o", out, "--sampling", "best"},
      {"scan", "--config", rig, "-o", out, "--exposure", "0"},
      {"scan", "--config", rig, "-o", out, "--stripe", "mass"},
      {"scan", "--config", rig, "-o", out, "--largest-angle", "91"},
      {"scan", "--config", rig, "-o", out, "--largest-hole", "-1"},
      {"scan", "--config", rig, "-o", out, "--resume", "--steps", "100"},
      {"scan", "--config", rig, "-o", out, "--resume", "--keep-frames"},
      {"scan", "--config", rig, "-o", out, "--resume", "--calibration", "1"},
      {"scan", "--config", rig, "-o", out, "--resume", "--stripe", "blais-rioux"},
  };
  for (const auto& words : lines) {
    const ProgramResult result = vitrine(words);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(words) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.output, "");
  }
  EXPECT_THAT(files(), ElementsAre("rig.json"));
}

TEST_F(ScannerCommands, AFaultOfTheConfigurationNamesFileAndKey) {
  const std::string rig = config(R"({"adress": "127.0.0.2"})");
  const ProgramResult result = vitrine({"scan", "--config", rig, "-o", path("out.ply")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("rig.json: camera: \"adress\" is an unknown key"));
  expect_fault(vitrine({"calibrate", "--config", rig}), 1);
  expect_fault(vitrine({"calibrate", "--config", path("absent.json")}), 1);
}

TEST_F(ScannerCommands, AFaultOfMeasuredPointsNamesFileAndLine) {
  const std::string rig = config();
  const auto fault_with = [&](const std::string& csv, const std::string& axis) {
    const ProgramResult result =
        vitrine({"calibrate", "--config", rig, "--correspondences", write("points.csv", csv),
                 "--axis", write("axis.json", axis)});
    expect_fault(result, 1);
    return result.errors;
  };
  const std::string csv = "u,v,x,y,pose\n1,2,3,4,0\n";
  const std::string axis = R"({"a": 0, "b": 0, "offset": 0, "tilt": 0, "clockwise": false})";
  EXPECT_THAT(fault_with(csv + "1,2,3\n", axis), HasSubstr("points.csv, line 3: expected four"));
  EXPECT_THAT(fault_with("", axis), HasSubstr("points.csv"));
  EXPECT_THAT(fault_with(csv, R"({"a": 0})"), HasSubstr("axis.json: \"b\" is missing"));
  EXPECT_THAT(fault_with(csv, axis), HasSubstr("camera"));  // no camera is connected
  EXPECT_THAT(files(), ElementsAre("axis.json", "points.csv", "rig.json"));
}

TEST_F(ScannerCommands, AScannerThatIsNotThereLeavesNothingBehind) {
  const std::string rig = config();
  ProgramResult scan = vitrine({"scan", "--config", rig, "-o", path("out.ply")});
  // Removes the notes that name the missing device. The command prints them while it retries.
  scan.errors = std::regex_replace(scan.errors, std::regex("vitrine: note: [^\n]*\n"), "");
  expect_fault(scan, 1);
  expect_fault(vitrine({"calibrate", "--config", rig}), 1);
  EXPECT_THAT(files(), ElementsAre("rig.json"));
}

TEST_F(ScannerCommands, WhatLayInTheScansFolderStaysThere) {
  std::filesystem::create_directory(path("out.ply.scan"));
  write("out.ply.scan/notes.txt", "the object's left side");
  EXPECT_EQ(vitrine({"scan", "--config", config(), "-o", path("out.ply")}).exit_code, 1);
  EXPECT_EQ(read("out.ply.scan/notes.txt"), "the object's left side");
  EXPECT_FALSE(std::filesystem::exists(path("out.ply.scan/profiles")));
}

TEST_F(ScannerCommands, ThereIsNothingToResume) {
  const ProgramResult result =
      vitrine({"scan", "--config", config(), "-o", path("out.ply"), "--resume"});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("there is no scan in"));
}

TEST_F(ScannerCommands, AMeshThatExistsIsNotReplacedWithoutForce) {
  const std::string out = write("out.ply", "mine");
  std::vector<std::string> words = {"scan", "--config", config(), "-o", out, "--resume"};
  const ProgramResult refused = vitrine(words);
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, HasSubstr("out.ply exists; choose another name, or replace it with "
                                        "--force"));
  words.emplace_back("--force");
  EXPECT_THAT(vitrine(words).errors, HasSubstr("there is no scan in"));
  EXPECT_EQ(read("out.ply"), "mine");
}

TEST_F(ScannerCommands, OutputsMustBeWritable) {
  const ProgramResult result =
      vitrine({"scan", "--config", config(), "-o", path("absent/out.ply")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("create the folder"));
}

}  // namespace
}  // namespace vitrine::test
