// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibrate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <optional>

#include "acquisition/calibration/keep_calibration.h"
#include "acquisition/calibration/report.h"
#include "acquisition/session/open_scanner.h"
#include "acquisition/session/rig_link.h"
#include "acquisition/session/target_pictures.h"
#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/measured_points.h"
#include "server/cli/stop_signals.h"

namespace vitrine::cli {
namespace {

using nlohmann::json;

Unexpected interrupted() {
  return fail(ErrorCode::kState, "calibration was interrupted; run it again from the start");
}

// A line from stdin; nothing at its end.
std::optional<std::string> read_line() {
  std::string line;
  for (char c = 0;;) {
    const ssize_t n = ::read(STDIN_FILENO, &c, 1);
    if (n < 0 && errno == EINTR && !StopSignals::arrived()) continue;
    if (n <= 0) return std::nullopt;
    if (c == '\n') return line;
    line += c;
  }
}

// Asks whoever is at the terminal.
Expected<bool> ask_operator(int number) {
  fmt::print(stderr,
             "Place {}: put the target on the table or before it, in the laser's line, and press "
             "Enter; or type \"done\" and Enter. ",
             number + 1);
  std::fflush(stderr);
  const auto line = read_line();
  if (StopSignals::arrived()) return interrupted();
  if (!line) return fail(ErrorCode::kState, "nobody answers; run vitrine calibrate in a terminal");
  return *line != "done";
}

// The simulated rig puts the target where it is told.
Expected<CalibrationInput> picture_at_rig(const ScannerConfig& config, const Scanner& scanner,
                                          const TargetPictureOptions& options,
                                          const std::function<void(double)>& progress) {
  auto rig = RigLink::connect(config.rig);
  if (!rig) return tl::unexpected(rig.error());
  const auto poses = rig->poses();
  if (!poses) return tl::unexpected(poses.error());
  const PlaceTarget place = [&](int number) -> Expected<bool> {
    if (StopSignals::arrived()) return interrupted();
    progress(static_cast<double>(number) / *poses);
    if (number >= *poses) return false;
    return rig->place_target(number).map([] { return true; });
  };
  EmergencyStop stop;
  auto input = picture_target(scanner, config.target, place, stop, options);
  const auto restored = rig->place_object();
  if (input && !restored) return tl::unexpected(restored.error());
  return input;
}

Expected<CalibrationInput> take_pictures(const ScannerConfig& config) {
  const StopSignals signals;
  const Scanner scanner = open_scanner(config);
  TargetPictureOptions options;
  options.is_interrupted = StopSignals::arrived;
  if (config.rig.empty()) {
    options.progress = print_note;
    EmergencyStop stop;
    return picture_target(scanner, config.target, ask_operator, stop, options);
  }
  ProgressBar bar;
  const ProgressReport report = bar.report();
  return picture_at_rig(config, scanner, options,
                        [&](double share) { report("pictures of the target", share); });
}

// Of pictures of the target; points that were measured by other means are all used.
std::string left_out(const CalibrationReport& report) {
  return fmt::format(
      "left out: {} points off the line ({:.2f} %), {} pictures without a clear line\n",
      report.strays, 100 * report.stray_share(), report.unclear);
}

std::string as_text(const Calibration& calibration, const CalibrationReport& report,
                    bool has_pictures, const std::string& plot) {
  const auto& [rms, p95, max] = calibration.residuals;
  return fmt::format(
      "calibration {} of camera {}: over held-out poses rms {:.4f} mm, p95 {:.4f} mm, max {:.4f} "
      "mm\n{} {}, {} points on the laser's line, polynomial of degree {}; covers {:.0f} % of "
      "the picture\n{}residuals: {}",
      calibration.number, calibration.camera, rms, p95, max, report.pictures,
      has_pictures ? "pictures" : "poses", report.points, calibration.map.degree(),
      100 * report.coverage.image_share, has_pictures ? left_out(report) : "", plot);
}

tl::expected<CalibrationOptions, Fault> options_of(const Arguments& arguments) {
  CalibrationOptions options;
  if (!arguments.has("--degree") || arguments.text("--degree") == "auto") return options;
  const auto degree = arguments.number("--degree", PlaneMap::kLeastDegree, PlaneMap::kMostDegree);
  if (!degree) return arguments.wrong_value("--degree", "auto or 2 to 5");
  if (*degree) options.degree = static_cast<int>(**degree);
  return options;
}

Expected<Calibrated> measure(const Arguments& arguments, const ScannerConfig& config,
                             const CalibrationOptions& options) {
  if (arguments.has("--correspondences")) {
    return calibrate_by(
        {.points = arguments.text("--correspondences"), .axis = arguments.text("--axis")}, config,
        options);
  }
  const auto input = take_pictures(config);
  if (!input) return tl::unexpected(input.error());
  return calibrate(*input, options);
}

Outcome check_usage(const Arguments& arguments) {
  if (!arguments.has("--config")) return misused("--config is missing; name the scanner's file");
  if (arguments.has("--correspondences") != arguments.has("--axis"))
    return misused("--correspondences and --axis go together; give both or none");
  return {};
}

Outcome run_calibrate(const Arguments& arguments) {
  if (auto right = check_usage(arguments); !right) return right;
  const auto options = options_of(arguments);
  if (!options) return tl::unexpected(options.error());
  const auto config = read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());

  const auto calibrated = measure(arguments, *config, *options);
  if (!calibrated) return failed(calibrated.error());
  const auto stored = keep_calibration(config->calibrations, *calibrated);
  if (!stored) return failed(stored.error());
  const std::string plot = residuals_file(config->calibrations, stored->number).string();
  if (!arguments.has("--json")) {
    const bool has_pictures = !arguments.has("--correspondences");
    return print(as_text(*stored, calibrated->report, has_pictures, plot));
  }
  json object = json::parse(report_json(*stored, calibrated->report), nullptr, false);
  object.update({{"rms", stored->residuals.rms},  // mm, over held-out poses
                 {"p95", stored->residuals.p95},
                 {"max", stored->residuals.max},
                 {"residual_plot", plot}});
  return print_json(object);
}

constexpr Flag kCalibrateFlags[] = {
    {"--config", "rig.json", "the scanner"},
    {"--correspondences", "FILE.csv",
     "instead of the target: the line u,v,x,y,pose, then points known in the laser plane"},
    {"--axis", "FILE.json", "with them: the table's axis, {a, b, offset, tilt, clockwise}"},
    {"--degree", "auto|2..5", "of the polynomial (default auto: by the held-out poses)"},
    {"--json", "", "print one JSON object"}};

}  // namespace

const Command kCalibrate = {
    "calibrate",
    "Calibrates a scanner by its target or by points; prints the error in mm.",
    {},
    kCalibrateFlags,
    run_calibrate};

}  // namespace vitrine::cli
