// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

#include "../codec/processor_time.h"
#include "acquisition/rig_optics/object_file.h"
#include "acquisition/session/open_scanner.h"
#include "acquisition/surface/surface_of.h"
#include "cast_profiles.h"
#include "rig_run.h"
#include "sections.h"
#include "simulated_scanner.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {
namespace {

// limits: milliseconds per stripe, and seconds per surface
constexpr double kExtraction = 3, kSurface = 5;
constexpr double kStripeNoise = 0.03;  // standard deviation of the noise, in mm
// Largest accepted time of a scan, as a multiple of the time that the camera alone takes. A scan
// processes one pair of pictures while the camera takes the next pair, and makes the mesh at the
// end.
constexpr double kOverCamera = 1.25;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void extraction(Report& report, const Object& object) {
  SimulatedScanner scanner(value_of(rig::load({.file = object.file})), {});
  std::vector<double> times;
  for (int angle = 0; angle < 360; angle += 12) {
    const FramePair frames = scanner.pictures(angle);
    for (int again = 0; again < 5; ++again)
      times.push_back(seconds([&] { value_of(find_stripe(frames.lit, frames.dark)); }));
  }
  judge(report, "speed.extraction", "ms_a_frame", 1000 * median(times), kExtraction);
}

void surface(Report& report, const Object& object) {
  auto profiles = cast_profiles(value_of(rig::load({.file = object.file})), 720, 0.08);
  add_noise(profiles, kStripeNoise);
  std::size_t points = 0;
  for (const Profile& profile : profiles)
    points += profile.points.size();
  const SurfaceOptions options{.noise = kStripeNoise, .sampling = {.noise = kStripeNoise}};
  const double time = seconds([&] { value_of(surface_of(profiles, options)); });
  judge(report, "speed.surface", "seconds_for_700k_points",
        time * 700'000 / static_cast<double>(points), kSurface);
}

double number_in(const std::filesystem::path& file) {
  double value = 0;
  std::ifstream(file) >> value;
  return value;
}

// Compares the time of a scan with that of the camera alone. Both use the same rig, so the time for
// rendering is the same.
void whole_scan(Report& report, const Options& options, const Object& object) {
  const int steps = options.is_quick ? 45 : 720;
  const std::string count = std::to_string(steps);
  const RigFolder folder;
  at_rig(folder, object, steps,
         program("vitrine") + " calibrate --config rig.json --json > calibration.json\n" +
             program("bench-scan") + " --bare-camera rig.json " + count + " > bare\n" +
             "date +%s.%N > begun\n" + program("vitrine") +
             " scan --config rig.json -o scan.ply --json > scan.json\ndate +%s.%N > ended\n");
  const double scan = number_in(folder / "ended") - number_in(folder / "begun");
  const double bare = number_in(folder / "bare");
  report.add({"speed.scan_of_" + count + "_steps", "ratio_to_camera", scan, bare, scan / bare,
              options.is_quick ? kNoThreshold : kOverCamera});
}

}  // namespace

int run_bare_camera(const std::filesystem::path& config, int steps) {
  const Scanner scanner = open_scanner(value_of(read_scanner_config(config)));
  EmergencyStop stop;
  auto live = value_of(LiveScanner::open(scanner.devices, scanner.settings, stop));
  value_of(live.find_position(0).map([] { return true; }));
  const auto begun = std::chrono::steady_clock::now();
  for (int step = 0; step < steps; ++step) {
    value_of(live.turn_to(360.0 * step / steps).map([] { return true; }));
    value_of(live.capture_pair());
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun;
  std::printf("%.3f\n", taken.count());
  return 0;
}

void speed(Report& report, const Options& options, const Object& object) {
  extraction(report, object);
  surface(report, object);
  whole_scan(report, options, object);
  emergency_stop(report, object);
}

}  // namespace vitrine::bench
