// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "accuracy.h"
#include "acquisition/rig/truth.h"
#include "acquisition/rig_optics/object_file.h"
#include "acquisition/session/processing.h"
#include "sections.h"
#include "simulated_scanner.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {
namespace {

// Reports the errors of scans of one object by several rigs.
class Table {
 public:
  Table(Report& report, const Object& object, int steps)
      : report_(report), name_(object.name), steps_(steps) {
    truth_.mesh = value_of(rig::load({.file = object.file}));
    truth_.seen = rig::seen_vertices(truth_.mesh, rig::Solid(truth_.mesh),
                                     rig::optics_of(rig::Realism{}.seed));
  }

  // over_speckle() and over_exposure() use half the steps, which are enough to show the
  // differences.
  void over_speckle() {
    for (const double speckle : {0.33, 0.5, 0.7, 1.0}) {
      rig::Realism realism;
      realism.look.speckle = speckle;
      SimulatedScanner scanner(truth_.mesh, realism);
      const Calibration calibration = calibration_of(scanner.picture_target());
      add(fmt::format("speckle_{:.2f}", speckle), scanner.scan(steps_ / 2), calibration);
    }
  }

  void over_exposure(const std::vector<double>& microseconds) {
    SimulatedScanner scanner(truth_.mesh, {});
    const Calibration calibration = calibration_of(scanner.picture_target());
    for (const double us : microseconds)
      add(fmt::format("exposure_{:.0f}_us", us), scanner.scan(steps_ / 2, us), calibration);
  }

  // Uses the same pictures for all rows, so that all rows have the same noise.
  void over_steps_and_degree() {
    SimulatedScanner scanner(truth_.mesh, {});
    const CalibrationInput target = scanner.picture_target();
    const std::vector<StripeAt> stripes = scanner.scan(steps_);
    for (int degree = PlaneMap::kLeastDegree; degree <= PlaneMap::kMostDegree; ++degree)
      add(fmt::format("degree_{}", degree), stripes, calibration_of(target, degree));
    const Calibration calibration = calibration_of(target);
    for (int every = 1; every <= 8 && steps_ % every == 0; every *= 2)
      add(fmt::format("steps_{}", steps_ / every), stripes, calibration, every);
  }

 private:
  void add(const std::string& row, const std::vector<StripeAt>& stripes,
           const Calibration& calibration, int every = 1) {
    const auto profiles = profiles_of(stripes, calibration, every);
    const TriangleMesh scan =
        at_height_of(value_of(mesh_of(profiles, calibration, {})).mesh, truth_.mesh);
    const Accuracy found = accuracy(scan, truth_);
    const std::string what = "error." + name_ + "." + row;
    judge(report_, what, "rms", found.rms());
    judge(report_, what, "p95", found.p95());
    judge(report_, what, "uncovered", 1 - found.truth_to_scan.within);
  }

  Report& report_;
  std::string name_;
  int steps_;
  Truth truth_;
};

}  // namespace

void error_table(Report& report, const Options& options, const Object& object) {
  Table table(report, object, options.is_quick ? 90 : 720);
  table.over_steps_and_degree();
  if (options.is_quick) return;
  table.over_speckle();
  table.over_exposure({1250, 2500, 10'000, 20'000});
}

}  // namespace vitrine::bench
