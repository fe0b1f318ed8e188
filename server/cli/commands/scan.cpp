// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan.h"

#include <fmt/format.h>

#include "acquisition/session/open_scanner.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/output.h"
#include "server/cli/support/processing_options.h"
#include "server/cli/support/scanned_mesh.h"
#include "server/cli/support/stop_signals.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kRequestFlags[] = {
    "--calibration",      "--steps",          "--exposure",     "--keep-frames",
    kStripeFlag.name,     kSamplingFlag.name, kLengthFlag.name, kLargestAngleFlag.name,
    kLargestHoleFlag.name};

tl::expected<acquisition::ScanRequest, Fault> request_of(const Arguments& arguments,
                                                         const acquisition::ScannerConfig& config) {
  const auto steps = arguments.number("--steps", acquisition::kLeastSteps, acquisition::kMostSteps);
  if (!steps) return tl::unexpected(steps.error());
  const auto exposure =
      arguments.number("--exposure", 1, static_cast<std::uint64_t>(acquisition::kMostExposure));
  if (!exposure) return tl::unexpected(exposure.error());
  const auto processing = processing_options(arguments, {});
  if (!processing) return tl::unexpected(processing.error());
  const auto calibration = arguments.number("--calibration", 1, acquisition::kMostCalibration);
  if (!calibration) return tl::unexpected(calibration.error());
  acquisition::ScanRequest request;
  request.calibration = static_cast<int>(calibration->value_or(0));
  request.processing = *processing;
  request.steps = static_cast<int>(steps->value_or(static_cast<std::uint64_t>(config.steps)));
  if (*exposure) request.exposure_us = static_cast<double>(**exposure);
  request.keeps_frames = arguments.has("--keep-frames");
  return request;
}

tl::expected<std::unique_ptr<acquisition::Scan>, Fault> open_scan(
    const Arguments& arguments, const acquisition::ScannerConfig& config,
    const std::string& folder) {
  const auto request = request_of(arguments, config);
  if (!request) return tl::unexpected(request.error());
  auto scan = arguments.has("--resume")
                  ? acquisition::Scan::reopen(open_scanner(config), folder)
                  : acquisition::Scan::create(open_scanner(config), *request, folder);
  if (!scan) return failed(scan.error());
  return std::move(*scan);
}

// Shows progress until the scan stops, and returns its last status. A stop signal pauses the scan.
acquisition::ScanStatus follow(acquisition::Scan& scan) {
  ProgressBar bar;
  const ProgressReport report = bar.report();
  std::string note;
  for (;;) {
    constexpr std::chrono::milliseconds kLook{100};
    const acquisition::ScanStatus status = scan.wait(kLook);
    if (!is_running(status.state)) return status;
    if (StopSignals::arrived())
      // The error is ignored: a scan that is being meshed cannot be paused, but it ends by itself.
      (void)scan.pause();
    if (!status.note.empty() && status.note != note) print_note(status.note);
    note = status.note;
    report(name_of(status.state), status.progress);
  }
}

CommandOutcome unfinished(const acquisition::Scan& scan, const acquisition::ScanStatus& status) {
  const auto record = scan.folder().record();
  // If no step was measured, --resume has nothing to continue, so the folder is removed.
  if (record && !*record) scan.folder().remove();
  if (status.state == acquisition::ScanState::kFailed) return failed(*status.error);
  return failed(fmt::format("the scan is {} after step {} of {}; {}", name_of(status.state),
                            status.steps_done, status.steps,
                            record && !*record ? "start it again" : "continue with --resume"));
}

CommandOutcome check_scan_usage(const Arguments& arguments) {
  if (!arguments.has("--config"))
    return misused("--config is missing; name the scanner's configuration file");
  for (const std::string_view flag : kRequestFlags) {
    if (arguments.has("--resume") && arguments.has(flag)) {
      return misused(fmt::format(
          "{} cannot change after the scan has begun; leave it out with --resume", flag));
    }
  }
  return {};
}

CommandOutcome run_scan(const Arguments& arguments) {
  if (auto right = check_scan_usage(arguments); !right) return right;
  const std::string out = arguments.text("-o"), folder = out + ".scan";
  const auto format = scan_output(arguments);
  if (!format) return tl::unexpected(format.error());
  const auto config = acquisition::read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());

  const StopSignals signals;
  auto scan = open_scan(arguments, *config, folder);
  if (!scan) return tl::unexpected(scan.error());
  if (auto started = (*scan)->resume(); !started) return failed(started.error());
  const acquisition::ScanStatus status = follow(**scan);
  if (status.state != acquisition::ScanState::kDone) return unfinished(**scan, status);
  const auto surface = (*scan)->surface();
  if (auto written = write_scanned(surface->mesh, *format, out); !written) return written;
  const auto record = (*scan)->folder().record();
  if (!record || !*record) return failed("the scan's record is gone; scan again");
  const json report =
      describe_scanned(*surface, status.stripe, **record, (*record)->calibration, out);
  const bool keep = arguments.has("--keep") || (*record)->request.keeps_frames;
  const acquisition::ScanFolder rest = (*scan)->folder();
  scan->reset();
  if (!keep) rest.remove();
  return arguments.has("--json") ? print_json(report) : print(scanned_as_text(report));
}

constexpr FixedText kStripeHelp =
    concatenate(kStripeFlag.help, " (default: derivative-of-gaussian)");
constexpr FixedText kSamplingHelp = concatenate(kSamplingFlag.help, " (default: adaptive)");
constexpr FixedText kLengthHelp = concatenate(kLengthFlag.help, " (default: 5)");
constexpr FixedText kLargestAngleHelp = concatenate(kLargestAngleFlag.help, " (default: 75)");
constexpr FixedText kLargestHoleHelp = concatenate(kLargestHoleFlag.help, " (default: 2)");
constexpr Flag kScanFlags[] = {
    {"--config", "rig.json",
     "configuration file of the scanner, which must be calibrated (required); see "
     "acquisition/README.md"},
    {"-o", "OUT.ply", "mesh file to write, in mm (required)"},
    {"--steps", "N", "steps per revolution, 8 to 36000 (default: steps in rig.json)"},
    {kStripeFlag.name, kStripeFlag.value, kStripeHelp},
    {kSamplingFlag.name, kSamplingFlag.value, kSamplingHelp},
    {kLengthFlag.name, kLengthFlag.value, kLengthHelp},
    {kLargestAngleFlag.name, kLargestAngleFlag.value, kLargestAngleHelp},
    {kLargestHoleFlag.name, kLargestHoleFlag.value, kLargestHoleHelp},
    {"--exposure", "US", "exposure time in microseconds (default: exposure_us in rig.json)"},
    {"--calibration", "N", "number of the calibration (default: the newest that fits the camera)"},
    {"--keep-frames", "", "keep the folder OUT.ply.scan, with all pictures, for vitrine reprocess"},
    {"--keep", "",
     "keep the folder OUT.ply.scan, without pictures, for vitrine fuse; repeat this flag with "
     "--resume"},
    {"--resume", "",
     "continue the interrupted scan in the folder OUT.ply.scan with the settings that it began "
     "with; excludes the flags from --steps to --keep-frames"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kScan = {
    .name = "scan",
    .summary = "Scans the object on a scanner's turntable and writes its mesh.",
    .details =
        "Ctrl-C interrupts the scan, with laser and motor off; its data stays in "
        "the folder OUT.ply.scan until --resume has completed it.",
    .flags = kScanFlags,
    .examples = "vitrine scan --config rig.json -o bust.ply",
    .run = run_scan};

}  // namespace vitrine::server::cli
