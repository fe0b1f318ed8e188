// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/scanned_mesh.h"

#include <fmt/format.h>

#include <filesystem>

#include "codec/files/atomic_file.h"
#include "server/cli/support/output.h"

namespace vitrine::server::cli {

using nlohmann::json;

tl::expected<MeshFormat, Fault> scan_output(const Arguments& arguments) {
  const std::string out = arguments.text("-o");
  if (out.empty()) return misused("-o is missing; name the output file");
  const auto format = format_of_extension(std::filesystem::path(out).extension().string());
  if (!format)
    return misused(fmt::format("cannot tell the output format from its name; use one of {}",
                               std::string_view(kExportSuffixes)));
  if (const auto free = check_output(arguments, out); !free) return failed(free.error());
  return *format;
}

CommandOutcome write_scanned(const TriangleMesh& mesh, MeshFormat format, const std::string& out) {
  const auto file = write_mesh(mesh, format, {.unit = "mm"});
  if (!file) return failed(file.error());
  if (const auto written = write_file_atomically(out, *file); !written)
    return failed(written.error());
  return {};
}

json describe_scanned(const acquisition::ScannedSurface& surface,
                      const acquisition::StripeCount& stripe, const acquisition::ScanRecord& record,
                      int calibration, const std::string& out) {
  const acquisition::SurfaceReport& report = surface.report;
  const acquisition::RowShares rows = shares(stripe, record.settings.region.height);
  return {
      {"out", out},
      {"steps", record.request.steps},
      {"camera", record.camera},
      {"calibration", calibration},
      {"vertices", surface.mesh.positions.size()},
      {"faces", surface.mesh.faces.size()},
      {"points",
       {{"measured", report.points},
        {"outliers", report.outliers},
        {"isolated", report.isolated},
        {"filled", report.filled}}},
      {"rows", {{"empty", rows.empty}, {"saturated", rows.saturated}, {"doubled", rows.doubled}}},
      {"spacing", report.spacing}};
}

std::string scanned_as_text(const json& r) {
  const int steps = r["steps"], done = r.value("steps_done", steps);
  return fmt::format(
      "{}: {} vertices, {} faces from {} points in {}{} steps, calibration {}; "
      "{:.1f} % of all rows show no stripe, {:.1f} % of the others are saturated, "
      "{:.1f} % show two",
      r["out"].get<std::string>(), r["vertices"].get<std::uint64_t>(),
      r["faces"].get<std::uint64_t>(), r["points"]["measured"].get<std::uint64_t>(),
      done < steps ? fmt::format("{} of ", done) : "", steps, r["calibration"].get<int>(),
      100 * r["rows"]["empty"].get<double>(), 100 * r["rows"]["saturated"].get<double>(),
      100 * r["rows"]["doubled"].get<double>());
}

}  // namespace vitrine::server::cli
