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
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/measured_points.h"
#include "server/cli/support/stop_signals.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;

Unexpected interrupted() {
  return fail(ErrorCode::kState, "calibration was interrupted; run it again from the start");
}

// Reads a line from stdin. Returns nullopt at the end of input or after a stop signal.
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

// Asks the operator at the terminal to place the target. Returns false if the operator has
// finished.
Expected<bool> ask_operator(int number) {
  fmt::print(
      stderr,
      "Pose {}: put the target on or in front of the table so that the laser line crosses it, "
      "and press Enter. To finish, type \"done\" and press Enter. ",
      number + 1);
  std::fflush(stderr);
  const auto line = read_line();
  if (StopSignals::arrived()) return interrupted();
  if (!line)
    return fail(ErrorCode::kState,
                "cannot ask for the target: stdin has ended; run vitrine calibrate in a terminal");
  return *line != "done";
}

// Takes the calibration pictures at the simulated rig. The rig places the target itself.
Expected<acquisition::CalibrationInput> picture_at_rig(
    const acquisition::ScannerConfig& config, const acquisition::Scanner& scanner,
    const acquisition::TargetPictureOptions& options, const std::function<void(double)>& progress) {
  auto rig = acquisition::RigLink::connect(config.rig);
  if (!rig) return tl::unexpected(rig.error());
  const auto poses = rig->poses();
  if (!poses) return tl::unexpected(poses.error());
  const acquisition::PlaceTarget place = [&](int number) -> Expected<bool> {
    if (StopSignals::arrived()) return interrupted();
    progress(static_cast<double>(number) / *poses);
    if (number >= *poses) return false;
    return rig->place_target(number).map([] { return true; });
  };
  acquisition::EmergencyStop stop;
  auto input = picture_target(scanner, config.target, place, stop, options);
  const auto restored = rig->place_object();
  if (input && !restored) return tl::unexpected(restored.error());
  return input;
}

Expected<acquisition::CalibrationInput> take_pictures(const acquisition::ScannerConfig& config) {
  const StopSignals signals;
  const acquisition::Scanner scanner = open_scanner(config);
  acquisition::TargetPictureOptions options;
  options.is_interrupted = StopSignals::arrived;
  if (config.rig.empty()) {
    options.progress = print_note;
    acquisition::EmergencyStop stop;
    return picture_target(scanner, config.target, ask_operator, stop, options);
  }
  ProgressBar bar;
  const ProgressReport report = bar.report();
  return picture_at_rig(config, scanner, options,
                        [&](double share) { report("pictures of the target", share); });
}

// Returns a line about the points and pictures that were not used. Only a calibration from pictures
// needs this line; a calibration from measured points uses all of its points.
std::string left_out(const acquisition::CalibrationReport& report) {
  return fmt::format(
      "left out: {} points off the line ({:.2f} %), {} pictures without a clear line\n",
      report.strays, 100 * report.stray_share(), report.unclear);
}

std::string as_text(const acquisition::Calibration& calibration,
                    const acquisition::CalibrationReport& report, bool has_pictures,
                    const std::string& plot) {
  const auto& [rms, p95, max] = calibration.residuals;
  return fmt::format(
      "calibration {} of camera {}: over held-out poses rms {:.4f} mm, p95 {:.4f} mm, max {:.4f} "
      "mm\n{} {}, {} points on the laser's line, polynomial of degree {}; covers {:.0f} % of "
      "the picture\n{}residuals: {}",
      calibration.number, calibration.camera, rms, p95, max, report.pictures,
      has_pictures ? "pictures" : "poses", report.points, calibration.map.degree(),
      100 * report.coverage.image_share, has_pictures ? left_out(report) : "", plot);
}

tl::expected<acquisition::CalibrationOptions, Fault> options_of(const Arguments& arguments) {
  acquisition::CalibrationOptions options;
  if (!arguments.has("--degree") || arguments.text("--degree") == "auto") return options;
  const auto degree = arguments.number("--degree", acquisition::PlaneMap::kLeastDegree,
                                       acquisition::PlaneMap::kMostDegree);
  if (!degree) return arguments.wrong_value("--degree", "auto or 2 to 5");
  if (*degree) options.degree = static_cast<int>(**degree);
  return options;
}

Expected<acquisition::Calibrated> measure(const Arguments& arguments,
                                          const acquisition::ScannerConfig& config,
                                          const acquisition::CalibrationOptions& options) {
  if (arguments.has("--correspondences")) {
    return calibrate_by(
        {.points = arguments.text("--correspondences"), .axis = arguments.text("--axis")}, config,
        options);
  }
  const auto input = take_pictures(config);
  if (!input) return tl::unexpected(input.error());
  return calibrate(*input, options);
}

CommandOutcome check_usage(const Arguments& arguments) {
  if (!arguments.has("--config"))
    return misused("--config is missing; name the scanner's configuration file");
  if (arguments.has("--correspondences") != arguments.has("--axis"))
    return misused("--correspondences and --axis need each other; give both or neither");
  return {};
}

CommandOutcome run_calibrate(const Arguments& arguments) {
  if (auto right = check_usage(arguments); !right) return right;
  const auto options = options_of(arguments);
  if (!options) return tl::unexpected(options.error());
  const auto config = acquisition::read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());

  const auto calibrated = measure(arguments, *config, *options);
  if (!calibrated) return failed(calibrated.error());
  const auto stored = acquisition::keep_calibration(config->calibrations, *calibrated);
  if (!stored) return failed(stored.error());
  const std::string plot =
      acquisition::residuals_file(config->calibrations, stored->number).string();
  if (!arguments.has("--json")) {
    const bool has_pictures = !arguments.has("--correspondences");
    return print(as_text(*stored, calibrated->report, has_pictures, plot));
  }
  json object = json::parse(acquisition::report_json(*stored, calibrated->report), nullptr, false);
  // residuals in mm, of the poses that were not used for the fit
  object.update({{"rms", stored->residuals.rms},
                 {"p95", stored->residuals.p95},
                 {"max", stored->residuals.max},
                 {"residual_plot", plot}});
  return print_json(object);
}

constexpr Flag kCalibrateFlags[] = {
    {"--config", "rig.json",
     "configuration file of the scanner (required); see acquisition/README.md"},
    {"--correspondences", "FILE.csv",
     "with --axis: measured points instead of pictures of the target; the first line is "
     "u,v,x,y,pose: pixel, position in the laser plane in mm, number of the pose"},
    {"--axis", "FILE.json",
     "with --correspondences: axis of the table as {a, b, offset, tilt, clockwise}; see "
     "acquisition/README.md"},
    {"--degree", "auto|2..5",
     "degree of the polynomial from pixels to mm; auto: the lowest whose error over held-out poses "
     "is at most 1 % above the least (default auto)"},
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kCalibrate = {
    .name = "calibrate",
    .summary = "Calibrates a scanner and prints the calibration's error in mm.",
    .details =
        "Asks at the terminal to place the target, a ChArUco board, in one pose after the other; "
        "the simulated scanner, vitrine-rig, places its target itself. With --correspondences and "
        "--axis, which need each other, uses measured points instead. Stores the calibration under "
        "a new number in the folder 'calibrations' that rig.json names; earlier calibrations stay.",
    .flags = kCalibrateFlags,
    .examples =
        "vitrine calibrate --config rig.json\n"
        "vitrine calibrate --config rig.json --correspondences points.csv --axis axis.json",
    .run = run_calibrate};

}  // namespace vitrine::server::cli
