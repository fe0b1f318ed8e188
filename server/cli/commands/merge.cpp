// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/merge.h"

#include <fmt/format.h>

#include "codec/files/atomic_file.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/scanned_mesh.h"
#include "server/cli/support/starts.h"
#include "server/cli/support/surface_file.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;

tl::expected<std::vector<InputFile>, Fault> open_all(const std::vector<std::string>& paths,
                                                     const std::string& out) {
  std::vector<InputFile> files;
  for (const std::string& path : paths) {
    if (const auto distinct = check_distinct(path, out); !distinct) return failed(distinct.error());
    auto file = InputFile::open(path);
    if (!file) return failed(file.error());
    files.push_back(std::move(*file));
  }
  return files;
}

json describe(const acquisition::Merged& merged, const std::vector<std::string>& paths,
              const acquisition::MergeOptions& options) {
  const auto numbers = [](const Vec3& v) { return json{v.x, v.y, v.z}; };
  json scans = json::array();
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const auto& [rows, shift] = merged.motions[k];
    scans.push_back({{"file", paths[k]},
                     {"rms", merged.rms[k]},
                     {"overlap", merged.shares[k]},
                     {"doubtful", is_doubtful(merged, k, options)},
                     {"rotation", {numbers(rows[0]), numbers(rows[1]), numbers(rows[2])}},
                     {"shift", numbers(shift)}});
  }
  return {{"vertices", merged.mesh.positions.size()},
          {"faces", merged.mesh.faces.size()},
          {"scans", std::move(scans)}};
}

Expected<Product> merge_files(const std::vector<InputFile>& files,
                              const std::vector<std::string>& paths,
                              const std::vector<RigidMotion>& starts,
                              const acquisition::MergeOptions& options, MeshFormat format) {
  std::vector<TriangleMesh> scans;
  for (std::size_t k = 0; k < files.size(); ++k) {
    auto scan = read_surface(files[k], paths[k]);
    if (!scan) return tl::unexpected(scan.error());
    convert(*scan, "mm");
    scans.push_back(std::move(scan->mesh));
  }
  const auto merged = merge(scans, starts, options);
  if (!merged) return tl::unexpected(merged.error());
  auto file = write_mesh(merged->mesh, format, "mm");
  if (!file) return tl::unexpected(file.error());
  return Product{describe(*merged, paths, options), std::move(*file)};
}

std::string as_text(const json& r) {
  std::string text =
      fmt::format("{}: {} vertices, {} faces", r["out"].get<std::string>(),
                  r["vertices"].get<std::uint64_t>(), r["faces"].get<std::uint64_t>());
  for (std::size_t k = 1; k < r["scans"].size(); ++k) {
    const json& scan = r["scans"][k];
    text += fmt::format("\n{}: rms {:.4f} mm to those before it, where {:.0f} % of it overlaps",
                        scan["file"].get<std::string>(), scan["rms"].get<double>(),
                        100 * scan["overlap"].get<double>());
  }
  return text;
}

void note_doubts(const json& report) {
  for (const json& scan : report["scans"]) {
    if (!scan["doubtful"].get<bool>()) continue;
    print_note(
        fmt::format("{} may be misaligned: too little of it overlaps with the scans before "
                    "it, or too loosely; look at the mesh, or give a better start",
                    scan["file"].get<std::string>()));
  }
}

CommandOutcome run_merge(const Arguments& arguments) {
  constexpr double kLeastOverlap = .001, kMostOverlap = 100;  // mm
  if (!arguments.has("--starts"))
    return misused("--starts is missing; name the file with the scans' approximate poses");
  const std::string out = arguments.text("-o");
  const auto format = scan_output(out);
  if (!format) return tl::unexpected(format.error());
  const auto overlap = arguments.number_between("--overlap", kLeastOverlap, kMostOverlap);
  if (!overlap) return tl::unexpected(overlap.error());
  acquisition::MergeOptions options;
  options.overlap = overlap->value_or(options.overlap);
  const auto starts = read_starts(arguments.text("--starts"));
  if (!starts) return failed(starts.error());
  const std::size_t scans = arguments.operands().size();
  if (starts->size() != scans) {
    return failed(fmt::format("{} has {} starts for {} scans; give {}, one for each but the first",
                              arguments.text("--starts"), starts->size() - 1, scans, scans - 1));
  }
  const auto files = open_all(arguments.operands(), out);
  if (!files) return tl::unexpected(files.error());

  auto product = isolate("cannot merge", [&](const ProgressReport&) {
    return merge_files(*files, arguments.operands(), *starts, options, *format);
  });
  if (!product) return tl::unexpected(product.error());
  if (const auto written = write_file_atomically(out, product->file); !written)
    return failed(written.error());
  product->report["out"] = out;
  note_doubts(product->report);
  return arguments.has("--json") ? print_json(product->report) : print(as_text(product->report));
}

constexpr std::string_view kMergeOperands[] = {"SCAN", "SCAN..."};
constexpr Flag kMergeFlags[] = {
    {"--starts", "FILE.json",
     "rough motion of each scan after the first onto the first (required): {\"starts\": "
     "[{\"axis\": {\"x\": 1}, \"degrees\": 180, \"shift\": {\"z\": 80}}]}, rotation about an axis "
     "through the origin, shift in mm; see acquisition/README.md"},
    {"-o", "OUT.ply", "mesh file to write, in mm, in the coordinates of the first scan (required)"},
    {"--overlap", "MM", "largest distance at which scans count as the same surface (default 0.5)"},
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kMerge = {.name = "merge",
                        .summary = "Merges scans of one object in several poses into one mesh.",
                        .details =
                            "SCAN is a mesh file in mm, as vitrine scan writes it. The first one "
                            "stays in place.",
                        .operands = kMergeOperands,
                        .flags = kMergeFlags,
                        .run = run_merge};

}  // namespace vitrine::server::cli
