// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/session_backend.h"

#include <gtest/gtest.h>

#include "acquisition/calibration/calibration_store.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

// Returns a calibration for pictures of 800 x 600 pixels. Its points are all in the upper left
// quarter.
Calibration of_a_quarter(const std::string& camera) {
  std::vector<Correspondence> points;
  for (int v = 0; v <= 300; v += 50) {
    for (int u = 0; u <= 400; u += 50)
      points.push_back({.u = double(u), .v = double(v), .at = {0.1 * u, 0.1 * v}});
  }
  return {.created = "2026-11-23T08:00:00Z",
          .camera = camera,
          .region = {.width = 800, .height = 600},
          .map = PlaneMap::fit(points, 2, 800, 600).value(),
          .residuals = {.rms = 0.02, .p95 = 0.04, .max = 0.06}};
}

TEST(SessionBackend, CalibrationsAreListedNewestFirstWithTheirCoverage) {
  const TemporaryFolder folder;
  const CalibrationStore store(folder.path());
  for (const char* camera : {"first", "second"})
    ASSERT_TRUE(store.add(of_a_quarter(camera)));
  SessionBackend backend({.calibrations = folder.path()}, {});
  const auto all = backend.calibrations();
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ(all->front().number, 2);
  EXPECT_EQ(all->front().camera, "second");
  EXPECT_EQ(all->front().p95, 0.04);
  EXPECT_NEAR(all->front().coverage, 0.25, 1e-6);
}

}  // namespace
}  // namespace vitrine::test
