// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan.h"

#include <fmt/format.h>

#include "acquisition/session/open_scanner.h"
#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/processing_options.h"
#include "server/cli/scanned_mesh.h"
#include "server/cli/stop_signals.h"

namespace vitrine::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kRequestFlags[] = {
    "--calibration",      "--steps",          "--exposure",     "--keep-frames",
    kStripeFlag.name,     kSamplingFlag.name, kLengthFlag.name, kLargestAngleFlag.name,
    kLargestHoleFlag.name};

tl::expected<ScanRequest, Fault> request_of(const Arguments& arguments,
                                            const ScannerConfig& config) {
  const auto steps = arguments.number("--steps", kLeastSteps, kMostSteps);
  if (!steps) return tl::unexpected(steps.error());
  const auto exposure =
      arguments.number("--exposure", 1, static_cast<std::uint64_t>(kMostExposure));
  if (!exposure) return tl::unexpected(exposure.error());
  const auto processing = processing_options(arguments, {});
  if (!processing) return tl::unexpected(processing.error());
  const auto calibration = arguments.number("--calibration", 1, kMostCalibration);
  if (!calibration) return tl::unexpected(calibration.error());
  ScanRequest request;
  request.calibration = static_cast<int>(calibration->value_or(0));
  request.processing = *processing;
  request.steps = static_cast<int>(steps->value_or(static_cast<std::uint64_t>(config.steps)));
  if (*exposure) request.exposure_us = static_cast<double>(**exposure);
  request.keep_frames = arguments.has("--keep-frames");
  return request;
}

tl::expected<std::unique_ptr<Scan>, Fault> open_scan(const Arguments& arguments,
                                                     const ScannerConfig& config,
                                                     const std::string& folder) {
  const auto request = request_of(arguments, config);
  if (!request) return tl::unexpected(request.error());
  auto scan = arguments.has("--resume") ? Scan::reopen(open_scanner(config), folder)
                                        : Scan::create(open_scanner(config), *request, folder);
  if (!scan) return failed(scan.error());
  return std::move(*scan);
}

// Shows how far it is until it comes to rest. A signal pauses it.
ScanStatus follow(Scan& scan) {
  ProgressBar bar;
  const ProgressReport report = bar.report();
  std::string note;
  for (;;) {
    constexpr std::chrono::milliseconds kLook{100};
    const ScanStatus status = scan.wait(kLook);
    if (!is_running(status.state)) return status;
    if (StopSignals::arrived()) (void)scan.pause();  // one that meshes ends by itself
    if (!status.note.empty() && status.note != note) print_note(status.note);
    note = status.note;
    report(name_of(status.state), status.progress);
  }
}

Outcome unfinished(const Scan& scan, const ScanStatus& status) {
  const auto record = scan.folder().record();
  // Nothing was measured that --resume could go on with.
  if (record && !*record) scan.folder().remove();
  if (status.state == ScanState::kFailed) return failed(*status.error);
  return failed(fmt::format("the scan is {} after step {} of {}; {}", name_of(status.state),
                            status.steps_done, status.steps,
                            record && !*record ? "start it again" : "go on with --resume"));
}

Outcome check_scan_usage(const Arguments& arguments) {
  if (!arguments.has("--config")) return misused("--config is missing; name the scanner's file");
  for (const std::string_view flag : kRequestFlags) {
    if (arguments.has("--resume") && arguments.has(flag)) {
      return misused(
          fmt::format("{} was chosen when the scan began; leave it out with --resume", flag));
    }
  }
  return {};
}

Outcome run_scan(const Arguments& arguments) {
  if (auto right = check_scan_usage(arguments); !right) return right;
  const std::string out = arguments.text("-o"), folder = out + ".scan";
  const auto format = scan_output(out);
  if (!format) return tl::unexpected(format.error());
  const auto config = read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());

  const StopSignals signals;
  auto scan = open_scan(arguments, *config, folder);
  if (!scan) return tl::unexpected(scan.error());
  if (auto started = (*scan)->resume(); !started) return failed(started.error());
  const ScanStatus status = follow(**scan);
  if (status.state != ScanState::kDone) return unfinished(**scan, status);
  const auto surface = (*scan)->surface();
  if (auto written = write_scanned(surface->mesh, *format, out); !written) return written;
  const auto record = (*scan)->folder().record();
  if (!record || !*record) return failed("the scan's record is gone; scan again");
  const json report =
      describe_scanned(*surface, status.stripe, **record, (*record)->calibration, out);
  const bool keep = (*record)->request.keep_frames;
  const ScanFolder rest = (*scan)->folder();
  scan->reset();
  if (!keep) rest.remove();
  return arguments.has("--json") ? print_json(report) : print(scanned_as_text(report));
}

constexpr Flag kScanFlags[] = {
    {"--config", "rig.json", "the scanner; it must be calibrated"},
    {"-o", "OUT.ply", "the mesh to write, in mm"},
    {"--steps", "N", "of one turn of the table (default: the scanner's)"},
    kStripeFlag,
    kSamplingFlag,
    kLengthFlag,
    kLargestAngleFlag,
    kLargestHoleFlag,
    {"--exposure", "US", "microseconds (default: the scanner's)"},
    {"--calibration", "N", "its number (default: the newest of this camera and region)"},
    {"--keep-frames", "", "keep OUT.ply.scan with all pictures"},
    {"--resume", "", "go on with the scan in OUT.ply.scan; it is there until it is done"},
    {"--json", "", "print one JSON object"}};

}  // namespace

const Command kScan = {"scan", "Scans the object on a scanner's table.", {}, kScanFlags, run_scan};

}  // namespace vitrine::cli
