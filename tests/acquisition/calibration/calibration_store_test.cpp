// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibration_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <thread>

#include "acquisition/calibration/calibration_json.h"
#include "acquisition/calibration/keep_calibration.h"
#include "support/temporary_folder.h"

namespace vitrine::acquisition {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const SensorRegion kRegion{0, 0, 1300, 1030};

Calibration example(const std::string& camera = "CAM-1", const SensorRegion& region = kRegion) {
  std::vector<Correspondence> points;
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      const double u = 101 * i + 7.3, v = 90.7 * j + 11.1;
      points.push_back({u, v, {u / 9.7 - v * v * 1e-5, 50 - v / 11.3 + u * v * 1e-6}, i});
    }
  }
  return {.number = 7,
          .created = "2026-11-23T08:00:00Z",
          .camera = camera,
          .region = region,
          .map = *PlaneMap::fit(points, 3, 1300, 1030),
          .axis = {.a = 1.0 / 3, .b = 0.1, .offset = -0.7, .tilt = 0.01, .is_clockwise = true},
          .residuals = {.rms = 0.0123456789012345, .p95 = 0.02, .max = 0.1},
          .noise = 0.011};
}

const Coverage kCovered{
    .x_low = -30, .x_high = 30, .y_low = 0, .y_high = 80};  // 60 x 80 mm, so its diagonal is 100 mm

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

template <class T>
std::string message(const Expected<T>& result) {
  return result ? "accepted" : result.error().message;
}

TEST(CalibrationJson, KeepsEveryBit) {
  const Calibration before = example();
  const auto after = calibration_from_json(to_json(before), "a file");
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(to_json(*after), to_json(before));
  EXPECT_EQ(after->region, before.region);
  EXPECT_EQ(after->axis.a, before.axis.a);
  EXPECT_EQ(after->residuals.rms, before.residuals.rms);
  for (const auto& [u, v] : {std::pair{300.1, 400.2}, {512.0, 17.9}, {1000.0, 900.0}}) {
    EXPECT_EQ(after->map.at(u, v)->x, before.map.at(u, v)->x);
    EXPECT_EQ(after->map.at(u, v)->y, before.map.at(u, v)->y);
  }
  EXPECT_FALSE(after->map.at(1200, 500));
}

TEST(CalibrationJson, CutAnywhereIsRefused) {
  const std::string text = to_json(example());
  for (std::size_t size = 0; size + 1 < text.size(); ++size) {
    ASSERT_THAT(message(calibration_from_json(text.substr(0, size), "0007.json")),
                HasSubstr("0007.json is not a complete JSON object"))
        << size;
  }
}

TEST(CalibrationJson, OutOfBoundsIsNamed) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = to_json(example());
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return message(calibration_from_json(text, "0007.json"));
  };
  EXPECT_EQ(with("CAM-1", "CAM-2"), "accepted");
  EXPECT_THAT(with("\"vitrine_calibration\": 1", "\"vitrine_calibration\": 2"),
              HasSubstr("0007.json: this program cannot read it as a calibration"));
  EXPECT_THAT(with("\"camera\"", "\"kamera\""), HasSubstr("\"camera\" is missing"));
  EXPECT_THAT(with("\"degree\": 3", "\"degree\": 5"), HasSubstr("\"terms\" is missing, out"));
  EXPECT_THAT(with("\"degree\": 3", "\"degree\": 1000000000"), HasSubstr("\"degree\""));
  EXPECT_THAT(with("\"degree\": 3", "\"degree\": 3.5"), HasSubstr("\"degree\""));
  EXPECT_THAT(with("\"width\": 1300", "\"width\": -1"), HasSubstr("\"width\""));
  EXPECT_THAT(with("\"width\": 1300", "\"width\": 1e300"), HasSubstr("\"width\""));
  EXPECT_THAT(with("\"half\"", "\"half\": 0, \"x\""), HasSubstr("\"half\""));
  EXPECT_THAT(with("\"clockwise\": true", "\"clockwise\": 1"), HasSubstr("\"clockwise\""));
  EXPECT_THAT(with("\"noise_mm\": 0.011", "\"noise_mm\": -1"), HasSubstr("\"noise_mm\""));
  EXPECT_THAT(with("\"hull\": [", "\"hull\": [[600, 500],"), HasSubstr("\"hull\""));
  EXPECT_THAT(with("\"hull\": [", "\"hull\": [[1],"), HasSubstr("\"hull\""));
  EXPECT_THAT(with("\"hull\": [", "\"hull\": [[1, 1e9],"), HasSubstr("\"hull\""));
  EXPECT_THAT(message(calibration_from_json("[1]", "x")),
              HasSubstr("is not a complete JSON object"));
}

TEST(CalibrationJson, AxisComesFromAFileOfItsOwn) {
  const auto axis = axis_from_json(
      R"({"a": 1.5, "b": -0.01, "offset": 0.2, "tilt": 0, "clockwise": true})", "axis.json");
  ASSERT_TRUE(axis) << axis.error().message;
  EXPECT_EQ(axis->a, 1.5);
  EXPECT_EQ(axis->b, -0.01);
  EXPECT_EQ(axis->offset, 0.2);
  EXPECT_TRUE(axis->is_clockwise);
  const auto fault = [](const char* text) { return message(axis_from_json(text, "axis.json")); };
  EXPECT_THAT(fault(R"({"a": 1.5})"), HasSubstr("axis.json: \"b\" is missing, out of range or"));
  EXPECT_THAT(fault(R"({"a": 0, "b": 0, "offset": 0, "tilt": 0, "clockwise": "no"})"),
              HasSubstr("\"clockwise\" is missing, out of range or of the wrong type; give a and"));
  EXPECT_THAT(fault(R"({"a": 0, "b": 0, "offset": 0, "tilt": 0, "clockwise": true, "z": 1})"),
              HasSubstr("axis.json: unknown key \"z\"; give a and offset (mm)"));
  EXPECT_EQ(fault("x").find("backup"), std::string::npos);
}

TEST(CalibrationStore, NumbersWhatIsAddedAndNeverChangesIt) {
  const TemporaryFolder folder;
  const CalibrationStore store(folder.path() / "calibrations");
  EXPECT_THAT(*store.numbers(), IsEmpty());
  const auto first = store.add(example());
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->number, 1);
  EXPECT_EQ(store.add(example("CAM-2"))->number, 2);
  EXPECT_THAT(*store.numbers(), ElementsAre(1, 2));
  EXPECT_EQ(store.load(1)->camera, "CAM-1");
  EXPECT_EQ(store.load(2)->camera, "CAM-2");
  write(folder.path() / "calibrations" / "notes.json", "{}");
  write(folder.path() / "calibrations" / "3.json", "{}");
  EXPECT_THAT(*store.numbers(), ElementsAre(1, 2));
}

TEST(CalibrationStore, GivesWritersAtATimeNumbersOfTheirOwn) {
  const TemporaryFolder folder;
  std::vector<std::vector<int>> numbers(4);
  std::vector<std::thread> writers;
  for (std::vector<int>& mine : numbers) {
    writers.emplace_back([&] {
      for (int i = 0; i < 8; ++i)
        mine.push_back(CalibrationStore(folder.path()).add(example())->number);
    });
  }
  std::set<int> all;
  for (std::size_t i = 0; i < writers.size(); ++i) {
    writers[i].join();
    all.insert(numbers[i].begin(), numbers[i].end());
  }
  EXPECT_EQ(all.size(), 32u);
  EXPECT_EQ(*all.rbegin(), 32);
}

TEST(CalibrationStore, PicksTheNewestThatFitsCameraAndRegion) {
  const TemporaryFolder folder;
  const CalibrationStore store(folder.path());
  const SensorRegion half{0, 0, 1300, 515};
  for (const Calibration& c : {example(), example(), example("CAM-1", half), example("CAM-2")})
    ASSERT_TRUE(store.add(c));
  EXPECT_EQ(store.for_camera("CAM-1", kRegion)->number, 2);
  EXPECT_EQ(store.for_camera("CAM-1", half)->number, 3);
  EXPECT_EQ(store.for_camera("CAM-2", kRegion)->number, 4);
}

TEST(CalibrationStore, RefusesWithNoneAndWithAnotherCameraOrRegion) {
  const TemporaryFolder folder;
  const CalibrationStore store(folder.path());
  EXPECT_THAT(message(store.for_camera("CAM-1", kRegion)),
              testing::AllOf(HasSubstr("there is no calibration in"),
                             HasSubstr("run `vitrine calibrate`")));
  ASSERT_TRUE(store.add(example("CAM-1")));
  EXPECT_THAT(message(store.for_camera("CAM-9", kRegion)),
              testing::AllOf(HasSubstr("camera CAM-9 is not calibrated"),
                             HasSubstr("calibrations of camera CAM-1; connect that camera")));
  EXPECT_THAT(message(store.for_camera("CAM-1", {8, 0, 640, 480})),
              HasSubstr("calibrated for the region 1300x1030+0+0, not for 640x480+8+0; set that"));
}

TEST(CalibrationStore, NamesTheDamagedFile) {
  const TemporaryFolder folder;
  const CalibrationStore store(folder.path());
  ASSERT_TRUE(store.add(example()));
  write(folder.path() / "0002.json", "{");
  EXPECT_THAT(message(store.for_camera("CAM-9", kRegion)),
              HasSubstr("0002.json is not a complete"));
  write(folder.path() / "0003.json", std::string((1 << 20) + 1, ' '));
  EXPECT_THAT(message(store.load(3)), HasSubstr("0003.json is too large"));
  write(folder.path() / "0004.json", to_json(example()));
  EXPECT_THAT(message(store.load(4)),
              HasSubstr("0004.json contains calibration 7: the file was renamed"));
  EXPECT_THAT(message(store.load(5)), HasSubstr("cannot read"));
}

TEST(CalibrationStore, TheNewestWholeOneIsTakenWhereANewerOneIsDamaged) {
  const TemporaryFolder folder;
  const CalibrationStore store(folder.path());
  ASSERT_TRUE(store.add(example()));
  write(folder.path() / "0002.json", "{");
  const auto found = store.for_camera("CAM-1", kRegion);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->number, 1);
}

TEST(CalibrationStore, ReportAndResidualsAreKeptBesideACalibration) {
  const TemporaryFolder folder;
  const auto kept =
      keep_calibration(folder.path(), {example(), {.pictures = 31, .coverage = kCovered}});
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->number, 1);
  EXPECT_TRUE(CalibrationStore(folder.path()).load(1));
  EXPECT_THAT(text_of(report_file(folder.path(), 1)), HasSubstr("31"));
  EXPECT_THAT(text_of(residuals_file(folder.path(), 1)), HasSubstr("<svg"));
}

TEST(CalibrationStore, OneThatIsFarOffOnHeldOutPosesIsNotKept) {
  const TemporaryFolder folder;
  const auto kept_with = [&](double rms) {
    return keep_calibration(folder.path(),
                            {example(), {.residuals = {.rms = rms}, .coverage = kCovered}});
  };
  for (const double rms : {1.01, 39., std::nan("")}) {
    EXPECT_THAT(message(kept_with(rms)), HasSubstr("1 % of the 100 mm that it covers; check"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
  EXPECT_TRUE(kept_with(.99));
}

TEST(CalibrationStore, DoesNotKeepWhatItCouldNotReadAgain) {
  const TemporaryFolder folder;
  Calibration broken = example();
  broken.noise = std::nan("");
  EXPECT_THAT(message(CalibrationStore(folder.path()).add(broken)), HasSubstr("\"noise_mm\""));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace vitrine::acquisition
