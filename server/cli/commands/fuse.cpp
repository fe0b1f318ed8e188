// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/fuse.h"

#include <fmt/format.h>

#include "acquisition/alignment/align_scans.h"
#include "acquisition/session/reprocess.h"
#include "acquisition/session/scan_calibration.h"
#include "acquisition/session/scanner_config.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/output.h"
#include "server/cli/support/scanned_mesh.h"

namespace vitrine::server::cli {
namespace {

using acquisition::PoseScan;
using nlohmann::json;

// Returns the mesh and the sight lines of a stored scan. Builds the mesh with the options of the
// scan's request.
Expected<PoseScan> read_pose(const std::string& path, const std::filesystem::path& calibrations) {
  constexpr std::size_t kLines = 2'000;  // number of points with sight lines
  const auto folder = acquisition::ScanFolder::open(path);
  if (!folder) return tl::unexpected(folder.error());
  const auto record = folder->record();
  if (!record) return tl::unexpected(record.error());
  if (!*record) return fail(ErrorCode::kState, path + " does not contain a scan; name another");
  auto surface = reprocess(*folder, calibrations, {.processing = (*record)->request.processing});
  if (!surface) return tl::unexpected(surface.error());
  const auto calibration = calibration_of(**record, calibrations);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto measured = folder->measured();
  if (!measured) return tl::unexpected(measured.error());
  return PoseScan{path, std::move(surface->mesh),
                  sight_lines(measured->profiles, *calibration, kLines)};
}

tl::expected<std::vector<PoseScan>, Fault> read_poses(const std::vector<std::string>& paths,
                                                      const std::filesystem::path& calibrations) {
  std::vector<PoseScan> scans;
  for (const std::string& path : paths) {
    auto scan = read_pose(path, calibrations);
    if (!scan) return failed(path + ": " + scan.error().message);
    scans.push_back(std::move(*scan));
  }
  return scans;
}

json describe(const TriangleMesh& mesh, const acquisition::Alignment& alignment,
              const std::vector<std::string>& paths, const std::string& out) {
  const auto numbers = [](const Vec3& v) { return json{v.x, v.y, v.z}; };
  json scans = json::array(), pairs = json::array();
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const auto& [rows, shift] = alignment.motions[k];
    scans.push_back({{"file", paths[k]},
                     {"rotation", {numbers(rows[0]), numbers(rows[1]), numbers(rows[2])}},
                     {"shift", numbers(shift)}});
  }
  for (const acquisition::PairQuality& pair : alignment.pairs) {
    pairs.push_back({{"from", paths[pair.from]},
                     {"to", paths[pair.to]},
                     {"overlap", pair.overlap},
                     {"rms", pair.rms},
                     {"crossed", pair.crossed}});
  }
  return {{"out", out},
          {"vertices", mesh.positions.size()},
          {"faces", mesh.faces.size()},
          {"scans", std::move(scans)},
          {"pairs", std::move(pairs)}};
}

std::string as_text(const json& r) {
  std::string text =
      fmt::format("{}: {} vertices, {} faces", r["out"].get<std::string>(),
                  r["vertices"].get<std::uint64_t>(), r["faces"].get<std::uint64_t>());
  for (const json& pair : r["pairs"]) {
    text += fmt::format("\n{} on {}: rms {:.4f} mm where they overlap, up to {:.0f} % of a scan",
                        pair["from"].get<std::string>(), pair["to"].get<std::string>(),
                        pair["rms"].get<double>(), 100 * pair["overlap"].get<double>());
  }
  return text;
}

tl::expected<acquisition::AlignmentOptions, Fault> alignment_options(const Arguments& arguments) {
  constexpr double kLeastOverlap = .001, kMostOverlap = 100;  // range of --overlap, in mm
  constexpr std::uint64_t kMostSeed = 1'000'000'000;
  acquisition::AlignmentOptions options;
  const auto overlap = arguments.number_between("--overlap", kLeastOverlap, kMostOverlap);
  if (!overlap) return tl::unexpected(overlap.error());
  const auto seed = arguments.number("--seed", 0, kMostSeed);
  if (!seed) return tl::unexpected(seed.error());
  options.reach = overlap->value_or(options.reach);
  options.seed = seed->value_or(options.seed);
  return options;
}

CommandOutcome run_fuse(const Arguments& arguments) {
  if (!arguments.has("--config"))
    return misused("--config is missing; name the scanner's configuration file");
  const std::string out = arguments.text("-o");
  const auto format = scan_output(arguments);
  if (!format) return tl::unexpected(format.error());
  const auto options = alignment_options(arguments);
  if (!options) return tl::unexpected(options.error());
  const auto config = acquisition::read_scanner_config(arguments.text("--config"));
  if (!config) return failed(config.error());
  const auto scans = read_poses(arguments.operands(), config->calibrations);
  if (!scans) return tl::unexpected(scans.error());

  const auto alignment = align_scans(*scans, *options);
  if (!alignment) return failed(alignment.error());
  const TriangleMesh mesh = fused_surface(*scans, alignment->motions, options->reach);
  if (auto written = write_scanned(mesh, *format, out); !written) return written;
  const json report = describe(mesh, *alignment, arguments.operands(), out);
  return arguments.has("--json") ? print_json(report) : print(as_text(report));
}

constexpr std::string_view kFuseOperands[] = {"SCAN_FOLDER", "SCAN_FOLDER..."};
constexpr Flag kFuseFlags[] = {
    {"--config", "rig.json", "configuration file of the scanner, for its calibrations (required)"},
    {"-o", "OUT.ply", "mesh file to write, in mm, in the coordinates of the first scan (required)"},
    {"--overlap", "MM", "largest distance at which scans count as the same surface (default 0.5)"},
    {"--seed", "N",
     "seed of the random search for poses; equal seeds give equal results "
     "(default 1)"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kFuse = {
    .name = "fuse",
    .summary = "Fuses scans of one object in several poses into one mesh.",
    .details =
        "SCAN_FOLDER is the folder OUT.ply.scan that vitrine scan --keep leaves. Finds the poses "
        "itself, and refuses a result that may be wrong. The first scan stays in place.",
    .operands = kFuseOperands,
    .flags = kFuseFlags,
    .examples = "vitrine fuse standing.ply.scan lying.ply.scan --config rig.json -o bust.ply",
    .run = run_fuse};

}  // namespace vitrine::server::cli
