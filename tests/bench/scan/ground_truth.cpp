// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "../codec/models.h"
#include "accuracy.h"
#include "codec/import/read_mesh.h"
#include "rig_run.h"
#include "sections.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {
namespace {

// Limits: rms and 95th percentile of the distances, in mm; share of the points that are not
// covered.
constexpr double kRms = 0.05, kP95 = 0.12, kUncovered = 0.03;
constexpr int kSteps = 720, kQuickSteps = 90;

void report_accuracy(Report& report, const std::string& what, const Accuracy& a, bool judged) {
  const auto limit = [&](double value) { return judged ? value : kNoThreshold; };
  judge(report, what, "scan_to_truth_rms", a.scan_to_truth.rms, limit(kRms));
  judge(report, what, "scan_to_truth_p95", a.scan_to_truth.p95, limit(kP95));
  judge(report, what, "seen_truth_to_scan_rms", a.truth_to_scan.rms, limit(kRms));
  judge(report, what, "seen_truth_to_scan_p95", a.truth_to_scan.p95, limit(kP95));
  judge(report, what, "uncovered", 1 - a.truth_to_scan.within, limit(kUncovered));
}

void scan_and_publish(const RigFolder& folder, const Object& object, int steps) {
  const std::string vitrine = program("vitrine");
  at_rig(folder, object, steps,
         vitrine + " calibrate --config rig.json --json > calibration.json\n" + vitrine +
             " scan --config rig.json -o scan.ply --json > scan.json\n" + vitrine +
             " build scan.ply --force -o scan.pmesh --json > build.json\n" + vitrine +
             " decode scan.pmesh --force -o decoded.ply --json > decode.json\n");
}

void report_calibration(Report& report, const std::string& what, const RigFolder& folder) {
  const auto calibration = nlohmann::json::parse(read_file(folder / "calibration.json"));
  for (const char* key : {"rms", "p95", "max"})
    judge(report, what, std::string("held_out_") + key, calibration.at(key).get<double>());
}

}  // namespace

void ground_truth(Report& report, const Options& options, const std::vector<Object>& objects) {
  const int steps = options.is_quick ? kQuickSteps : kSteps;
  for (const Object& object : objects) {
    const RigFolder folder;
    scan_and_publish(folder, object, steps);
    const std::string what = "ground_truth." + object.name;
    report_calibration(report, what + ".calibration", folder);
    const Truth truth = read_truth(folder / "truth.ply");
    const TriangleMesh scan =
        at_height_of(value_of(read_mesh(read_file(folder / "decoded.ply"))).mesh, truth.mesh);
    report_accuracy(report, what + ".unaligned", accuracy(scan, truth), !options.is_quick);
    report_accuracy(report, what + ".aligned", accuracy(aligned(scan, truth.mesh), truth),
                    !options.is_quick);
    if (options.is_quick) break;
  }
}

}  // namespace vitrine::bench
