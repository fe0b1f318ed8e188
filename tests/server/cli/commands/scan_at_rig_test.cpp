// SPDX-License-Identifier: Apache-2.0
// Tests a complete scan over the real protocols. vitrine-rig simulates the scanner and the
// calibration target. The program `vitrine` calibrates the scanner and scans an object. The test
// compares the result with the true surface.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "acquisition/calibration/calibration_store.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kSteps = 60;

class ScanAtRig : public VitrineCommand {
 protected:
  ScanAtRig() { write("object.ply", bumpy_ply(3'000)); }

  // Runs the script with a simulated rig, in the test's folder. In this folder, rig.json describes
  // the scanner.
  ProgramResult at_rig(const std::string& script, const std::vector<std::string>& options = {}) {
    std::vector<std::string> words = {VITRINE_BIN_DIR "/vitrine-rig",
                                      "--mesh",
                                      path("object.ply"),
                                      "--height-mm",
                                      "40",
                                      "--steps",
                                      std::to_string(kSteps),
                                      "--private-network",
                                      "--write-config",
                                      path("rig.json"),
                                      "--write-truth",
                                      path("truth.ply")};
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--", "sh", "-c", "cd \"$0\" || exit; vitrine=\"$1\"; " + script,
                               folder_.path().string(), kVitrine});
    return run_program(words);
  }
  // Calibrates the rig and stores the result as calibration 1. Later rigs have the same seed, so
  // the calibration is also valid for them.
  void calibrate() {
    const ProgramResult result =
        at_rig("\"$vitrine\" calibrate --config rig.json --json > calibration.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  // Returns, as CSV, the points that a measuring machine would find for calibration 1. Coordinates
  // are rounded to micrometres.
  std::string measured_points() const {
    const PlaneMap map = CalibrationStore(path("calibrations")).load(1).value().map;
    std::string csv = "u,v,x,y,pose\n";
    for (int v = 0, pose = 0; v < 1030; v += 10, ++pose) {
      for (int u = 0; u < 1300; u += 20) {
        if (const auto at = map.at(u, v))
          csv += fmt::format("{},{},{:.3f},{:.3f},{}\n", u, v, at->x, at->y, pose);
      }
    }
    return csv;
  }
  static std::string scan_to(const std::string& out, const std::string& more = "") {
    return "\"$vitrine\" scan --config rig.json -o " + out + " " + more;
  }
  // Returns a script that starts a scan to `out`. The script sends `signal` to the scan after a few
  // steps have been stored.
  static std::string stopped_amid(const std::string& signal, const std::string& out) {
    return scan_to(out) + " & scan=$!; " + "until [ -e " + out + " ] || [ \"$(stat -c %s " + out +
           ".scan/profiles 2>/dev/null || echo 0)\" -gt 20000 ]; "
           "do sleep 0.02; done; kill -" +
           signal + " $scan; wait $scan; test ! -e " + out;
  }
  // Scans without faults and returns the mesh.
  std::string undisturbed() {
    const ProgramResult result = at_rig(scan_to("calm.ply", "--json > scan.json"));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(path("calm.ply.scan")));
    return read("calm.ply");
  }
};

TEST_F(ScanAtRig, ACalibratedScannerMeasuresWhatStandsOnItsTable) {
  calibrate();
  const json calibration = json::parse(read("calibration.json"));
  EXPECT_LT(calibration["rms"].get<double>(), 0.2);
  EXPECT_EQ(calibration["number"], 1);
  EXPECT_TRUE(std::filesystem::exists(path("calibrations/0001.svg")));
  EXPECT_TRUE(std::filesystem::exists(path("calibrations/0001.report.json")));
  undisturbed();
  const json scan = json::parse(read("scan.json"));
  EXPECT_EQ(scan["steps"], kSteps);
  EXPECT_EQ(scan["calibration"], 1);
  EXPECT_GT(scan["faces"].get<int>(), 1'000);
  const json distance = vitrine_json({"measure", path("calm.ply"), path("truth.ply"), "--align"});
  EXPECT_LT(distance["a_to_b"]["rms"].get<double>(), 0.5);
}

TEST_F(ScanAtRig, PointsAndAnAxisThatAreKnownCalibrateItAsTheTargetDoes) {
  calibrate();
  const json by_target = json::parse(read("calibration.json"));
  write("points.csv", measured_points());
  write("axis.json", by_target["axis"].dump());
  const ProgramResult result = at_rig(
      "\"$vitrine\" calibrate --config rig.json --correspondences points.csv --axis axis.json "
      "--json > by_points.json && " +
      scan_to("out.ply", "--json > scan.json"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json by_points = json::parse(read("by_points.json"));
  EXPECT_EQ(by_points["number"], 2);
  EXPECT_LT(by_points["rms"].get<double>(), 0.001);
  for (const char* same : {"camera", "region", "axis"})
    EXPECT_EQ(by_points[same], by_target[same]);
  EXPECT_TRUE(std::filesystem::exists(by_points["residual_plot"].get<std::string>()));
  EXPECT_EQ(json::parse(read("scan.json"))["calibration"], 2);
  const json distance = vitrine_json({"measure", path("out.ply"), path("truth.ply"), "--align"});
  EXPECT_LT(distance["a_to_b"]["rms"].get<double>(), 0.5);
}

TEST_F(ScanAtRig, UnpluggedDevicesAndMissingPacketsChangeNothing) {
  calibrate();
  const std::string expected = undisturbed();
  for (const std::string fault :
       {"camera-unplug@20", "usb-unplug@30", "lost-packets", "missed-trigger@25"}) {
    const ProgramResult result = at_rig(scan_to("out.ply", "--force"), {"--fault", fault});
    EXPECT_EQ(result.exit_code, 0) << fault << ": " << result.errors;
    EXPECT_TRUE(read("out.ply") == expected) << fault;
  }
}

TEST_F(ScanAtRig, KilledOrInterruptedAndResumedItIsTheSameMesh) {
  calibrate();
  const std::string expected = undisturbed();
  for (const std::string signal : {"KILL", "INT"}) {
    const std::string out = signal + ".ply";
    const std::string script = stopped_amid(signal, out) + " && { " +
                               scan_to("other.ply", "--resume") + "; test $? = 1; } && " +
                               scan_to(out, "--resume");
    const ProgramResult result = at_rig(script);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(read(out) == expected) << signal;
  }
}

TEST_F(ScanAtRig, ARestartedRigContinuesAtItsTablesPosition) {
  calibrate();
  const std::string expected = undisturbed();
  const std::vector<std::string> table = {"--table", path("table")};
  ProgramResult result = at_rig(stopped_amid("INT", "out.ply"), table);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  result = at_rig(scan_to("out.ply", "--resume"), table);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(read("out.ply") == expected);
}

// A step of this scan is 53.3 motor steps, but the table can stop only at whole motor steps. A
// resumed scan must round to the same motor steps as an undisturbed scan.
TEST_F(ScanAtRig, ABoardThatDoesNotCountContinuesAtTheSameMotorStep) {
  calibrate();
  const std::vector<std::string> fabscan = {"--dialect", "fabscan"};
  ProgramResult result = at_rig(scan_to("expected.ply"), fabscan);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  result =
      at_rig(scan_to("unplugged.ply"), {"--dialect", "fabscan", "--fault", "camera-unplug@20"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(read("unplugged.ply") == read("expected.ply"));
  result = at_rig(stopped_amid("INT", "stopped.ply") + " && " + scan_to("stopped.ply", "--resume"),
                  fabscan);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(read("stopped.ply") == read("expected.ply"));
}

TEST_F(ScanAtRig, AnUncalibratedScannerDoesNotScan) {
  const ProgramResult result = at_rig(scan_to("out.ply"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("there is no calibration in"));
  EXPECT_FALSE(std::filesystem::exists(path("out.ply.scan")));
}

}  // namespace
}  // namespace vitrine::test
