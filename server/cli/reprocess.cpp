// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include <fmt/format.h>

#include "acquisition/session/scanner_config.h"
#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/processing_options.h"
#include "server/cli/scanned_mesh.h"

namespace vitrine::cli {
namespace {

tl::expected<ReprocessOptions, Fault> options_of(const Arguments& arguments,
                                                 const ScanRecord& record) {
  const auto processing = processing_options(arguments, record.request.processing);
  if (!processing) return tl::unexpected(processing.error());
  const auto number = arguments.number("--calibration", 1, kMostCalibration);
  if (!number) return tl::unexpected(number.error());
  return ReprocessOptions{.processing = *processing,
                          .calibration = static_cast<int>(
                              number->value_or(static_cast<std::uint64_t>(record.calibration)))};
}

tl::expected<Reprocessed, Fault> mesh_anew(const ScanFolder& folder, const ScannerConfig& config,
                                           ReprocessOptions options) {
  ProgressBar bar;
  options.progress = [report = bar.report()](double share) { report("stripes", share); };
  auto surface = reprocess(folder, config.calibrations, options);
  if (!surface) return failed(surface.error());
  return std::move(*surface);
}

Outcome run_reprocess(const Arguments& arguments) {
  if (!arguments.has("--config")) return misused("--config is missing; name the scanner's file");
  const std::string out = arguments.text("-o");
  const auto format = scan_output(out);
  if (!format) return tl::unexpected(format.error());
  const auto config = read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());
  const auto folder = ScanFolder::open(arguments.operand(0));
  if (!folder) return failed(folder.error());
  const auto record = folder->record();
  if (!record) return failed(record.error());
  if (!*record) return failed("there is no scan in that folder any more; name another");
  const auto options = options_of(arguments, **record);
  if (!options) return tl::unexpected(options.error());

  const auto surface = mesh_anew(*folder, *config, *options);
  if (!surface) return tl::unexpected(surface.error());
  if (auto written = write_scanned(surface->mesh, *format, out); !written) return written;
  const int steps = (*record)->request.steps;
  if (surface->steps < steps) {
    print_note(fmt::format("the scan ended after step {} of {}: the mesh is of these alone",
                           surface->steps, steps));
  }
  auto report = describe_scanned(*surface, surface->stripe, **record, options->calibration, out);
  report["steps_done"] = surface->steps;
  return arguments.has("--json") ? print_json(report) : print(scanned_as_text(report));
}

constexpr std::string_view kReprocessOperands[] = {"SCAN_FOLDER"};
constexpr Flag kReprocessFlags[] = {
    {"--config", "rig.json", "the scanner, whose calibrations are used"},
    {"-o", "OUT.ply", "the mesh to write, in mm"},
    kStripeFlag,
    kSamplingFlag,
    kLengthFlag,
    kLargestAngleFlag,
    kLargestHoleFlag,
    {"--calibration", "N", "its number (default: the scan's own)"},
    {"--json", "", "print one JSON object"}};

}  // namespace

const Command kReprocess = {"reprocess",
                            "Makes a scan's mesh anew; what is not chosen is as in the scan. "
                            "--stripe and --calibration need its pictures (scan --keep-frames).",
                            kReprocessOperands, kReprocessFlags, run_reprocess};

}  // namespace vitrine::cli
