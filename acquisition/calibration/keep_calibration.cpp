// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/keep_calibration.h"

#include <fmt/core.h>

#include <cmath>

#include "acquisition/calibration/calibration_store.h"
#include "codec/files/atomic_file.h"

namespace vitrine::acquisition {
namespace {

Expected<void> write_text(const std::filesystem::path& file, const std::string& text) {
  return write_file_atomically(file,
                               {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

Expected<void> check_rms(const CalibrationReport& report) {
  const Coverage& area = report.coverage;
  const double rms = report.residuals.rms,
               size = std::hypot(area.x_high - area.x_low, area.y_high - area.y_low);
  if (rms <= kLargestRms * size) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("the calibration is not kept: over held-out poses its rms is {:.4g} mm, "
                          "more than {:g} % of the {:.4g} mm that it covers; check the target's "
                          "dimensions, or the points and their units, and calibrate again",
                          rms, 100 * kLargestRms, size));
}

}  // namespace

std::filesystem::path report_file(const std::filesystem::path& folder, int number) {
  return folder / fmt::format("{:04}.report.json", number);
}

std::filesystem::path residuals_file(const std::filesystem::path& folder, int number) {
  return folder / fmt::format("{:04}.svg", number);
}

Expected<Calibration> keep_calibration(const std::filesystem::path& folder,
                                       const Calibrated& calibrated) {
  if (const auto good = check_rms(calibrated.report); !good) return tl::unexpected(good.error());
  auto stored = CalibrationStore(folder).add(calibrated.calibration);
  if (!stored) return stored;
  const CalibrationReport& report = calibrated.report;
  const auto written =
      write_text(report_file(folder, stored->number), report_json(*stored, report)).and_then([&] {
        return write_text(residuals_file(folder, stored->number), residual_plot(*stored, report));
      });
  if (!written) return tl::unexpected(written.error());
  return stored;
}

}  // namespace vitrine::acquisition
