// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/keep_calibration.h"

#include <fmt/core.h>

#include "acquisition/calibration/calibration_store.h"
#include "codec/files/atomic_file.h"

namespace vitrine {
namespace {

Expected<void> write_text(const std::filesystem::path& file, const std::string& text) {
  return write_file_atomically(file,
                               {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
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
  auto stored = CalibrationStore(folder).add(calibrated.calibration);
  if (!stored) return stored;
  const CalibrationReport& report = calibrated.report;
  const auto written =
      write_text(report_file(folder, stored->number), report_json(*stored, report)).and_then([&] {
        return write_text(residuals_file(folder, stored->number), residual_plot(*stored, report));
      });
  if (!written) return tl::make_unexpected(written.error());
  return stored;
}

}  // namespace vitrine
