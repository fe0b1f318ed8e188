// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/measured_points.h"

#include "acquisition/calibration/calibration_json.h"
#include "acquisition/calibration/correspondences.h"
#include "acquisition/session/open_scanner.h"
#include "server/cli/support/input.h"

namespace vitrine::server::cli {
namespace {

std::string_view text_in(const InputFile& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

Expected<std::vector<acquisition::Correspondence>> points_in(const std::string& path) {
  const auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  return acquisition::read_correspondences(text_in(*file), path);
}

Expected<acquisition::TurntableAxis> axis_in(const std::string& path) {
  const auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  return acquisition::axis_from_json(text_in(*file), path);
}

}  // namespace

Expected<acquisition::Calibrated> calibrate_by(const MeasuredFiles& files,
                                               const acquisition::ScannerConfig& config,
                                               const acquisition::CalibrationOptions& options) {
  const auto points = points_in(files.points);
  if (!points) return tl::unexpected(points.error());
  const auto axis = axis_in(files.axis);
  if (!axis) return tl::unexpected(axis.error());
  const acquisition::Scanner scanner = open_scanner(config);
  const auto camera = scanner.devices.open_camera();
  if (!camera) return tl::unexpected(camera.error());
  if (auto set = (*camera)->configure(scanner.settings); !set) return tl::unexpected(set.error());
  return calibrate(*points, *axis, (*camera)->identity().serial, (*camera)->region(), options);
}

}  // namespace vitrine::server::cli
