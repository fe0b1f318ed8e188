// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include <fmt/format.h>

#include "acquisition/session/scanner_config.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/output.h"
#include "server/cli/support/processing_options.h"
#include "server/cli/support/scanned_mesh.h"

namespace vitrine::server::cli {
namespace {

tl::expected<acquisition::ReprocessOptions, Fault> options_of(
    const Arguments& arguments, const acquisition::ScanRecord& record) {
  const auto processing = processing_options(arguments, record.request.processing);
  if (!processing) return tl::unexpected(processing.error());
  const auto number = arguments.number("--calibration", 1, acquisition::kMostCalibration);
  if (!number) return tl::unexpected(number.error());
  return acquisition::ReprocessOptions{
      .processing = *processing,
      .calibration =
          static_cast<int>(number->value_or(static_cast<std::uint64_t>(record.calibration)))};
}

tl::expected<acquisition::Reprocessed, Fault> rebuild_mesh(const acquisition::ScanFolder& folder,
                                                           const acquisition::ScannerConfig& config,
                                                           acquisition::ReprocessOptions options) {
  ProgressBar bar;
  options.progress = [report = bar.report()](double share) { report("stripes", share); };
  auto surface = reprocess(folder, config.calibrations, options);
  if (!surface) return failed(surface.error());
  return std::move(*surface);
}

CommandOutcome run_reprocess(const Arguments& arguments) {
  if (!arguments.has("--config"))
    return misused("--config is missing; name the scanner's configuration file");
  const std::string out = arguments.text("-o");
  const auto format = scan_output(arguments);
  if (!format) return tl::unexpected(format.error());
  const auto config = acquisition::read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());
  const auto folder = acquisition::ScanFolder::open(arguments.operand(0));
  if (!folder) return failed(folder.error());
  const auto record = folder->record();
  if (!record) return failed(record.error());
  if (!*record) return failed("the folder does not contain a scan; name another");
  const auto options = options_of(arguments, **record);
  if (!options) return tl::unexpected(options.error());

  const auto surface = rebuild_mesh(*folder, *config, *options);
  if (!surface) return tl::unexpected(surface.error());
  if (auto written = write_scanned(surface->mesh, *format, out); !written) return written;
  const int steps = (*record)->request.steps;
  if (surface->steps < steps) {
    print_note(fmt::format("the scan ended after step {} of {}: the mesh contains only these steps",
                           surface->steps, steps));
  }
  auto report = describe_scanned(*surface, surface->stripe, **record, options->calibration, out);
  report["steps_done"] = surface->steps;
  return arguments.has("--json") ? print_json(report) : print(scanned_as_text(report));
}

constexpr std::string_view kReprocessOperands[] = {"SCAN_FOLDER"};
constexpr Flag kReprocessFlags[] = {
    {"--config", "rig.json", "configuration file of the scanner, for its calibrations (required)"},
    {"-o", "OUT.ply", "mesh file to write, in mm (required)"},
    kStripeFlag,
    kSamplingFlag,
    kLengthFlag,
    kLargestAngleFlag,
    kLargestHoleFlag,
    {"--calibration", "N", "number of the calibration (default: the one the scan used)"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kReprocess = {
    .name = "reprocess",
    .summary = "Rebuilds the mesh of a stored scan.",
    .details =
        "SCAN_FOLDER is the folder OUT.ply.scan that vitrine scan --keep-frames or --keep leaves. "
        "Flags not given keep the values used by the scan. --stripe and --calibration need the "
        "pictures of the scan (--keep-frames), because they evaluate the pictures again.",
    .operands = kReprocessOperands,
    .flags = kReprocessFlags,
    .examples = "vitrine reprocess bust.ply.scan --config rig.json -o again.ply --sampling paper",
    .run = run_reprocess};

}  // namespace vitrine::server::cli
