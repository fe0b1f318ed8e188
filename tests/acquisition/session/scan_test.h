// SPDX-License-Identifier: Apache-2.0
// Test fixture: a scan with the fake scanner, in a folder of its own.
#pragma once

#include <gmock/gmock.h>

#include "acquisition/calibration/calibration_store.h"
#include "acquisition/session/scan.h"
#include "fake_scanner.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

inline constexpr int kSteps = 12;
inline constexpr std::chrono::hours kForever{1};

class ScanTest : public testing::Test {
 protected:
  ScanTest() { EXPECT_TRUE(CalibrationStore(calibrations_).add(fake_calibration())); }
  ~ScanTest() override { expect_dark(world_); }

  // Expects laser and motor to be off and the devices to be closed.
  static void expect_dark(const FakeWorld& world) {
    const std::lock_guard lock(world.mutex);
    EXPECT_FALSE(world.laser);
    EXPECT_FALSE(world.motor);
    EXPECT_EQ(world.open_boards, 0);
    EXPECT_EQ(world.open_cameras, 0);
  }

  static ScanRequest request() { return {.steps = kSteps}; }
  static ScanSettings impatient(int tries = 3) {
    return {.retries = {.tries = tries, .first_tries = 0, .between = std::chrono::milliseconds(0)}};
  }
  Scanner scanner() { return fake_scanner(world_, calibrations_); }
  std::filesystem::path path(const std::string& name = "scan") const {
    return folder_.path() / name;
  }

  std::unique_ptr<Scan> scan(const std::string& name = "scan",
                             const ScanRequest& request = {.steps = kSteps}) {
    auto made = Scan::create(scanner(), request, path(name), impatient());
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
  }
  std::unique_ptr<Scan> reopened(const std::string& name = "scan") {
    auto opened = Scan::reopen(scanner(), path(name), impatient());
    EXPECT_TRUE(opened) << opened.error().message;
    return std::move(*opened);
  }

  // Runs the scan and returns its final state.
  static ScanState run(Scan& scan) {
    const auto started = scan.resume();
    EXPECT_TRUE(started) << started.error().message;
    return scan.wait(kForever).state;
  }

  static std::string mesh_text(const Scan& scan) {
    const auto surface = scan.surface();
    if (!surface) return "no mesh: " + scan.status().error.value_or(Error{}).message;
    std::string text;
    const auto add = [&](const auto& items) {
      text.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof items[0]);
    };
    add(surface->mesh.positions), add(surface->mesh.faces);
    return text;
  }
  // Returns the mesh of a scan without faults or interruptions.
  std::string undisturbed() {
    FakeWorld calm;
    auto made = Scan::create(fake_scanner(calm, calibrations_), request(), path("undisturbed"),
                             impatient());
    EXPECT_EQ(run(**made), ScanState::kDone);
    expect_dark(calm);
    return mesh_text(**made);
  }

  TemporaryFolder folder_;
  const std::filesystem::path calibrations_ = folder_.path() / "calibrations";
  FakeWorld world_;
};

}  // namespace vitrine::test
