// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan_calibration.h"

#include <fmt/format.h>

#include <span>

#include "acquisition/calibration/calibration_json.h"
#include "acquisition/calibration/calibration_store.h"
#include "codec/core/sha256.h"

namespace vitrine::acquisition {

std::string digest_of(const Calibration& calibration) {
  const std::string text = to_json(calibration);
  return to_hex(sha256(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())));
}

Expected<void> fits(const Calibration& calibration, const std::string& camera,
                    const SensorRegion& region) {
  if (calibration.camera == camera && calibration.region == region) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("calibration {} is for another camera or region than the scan; choose "
                          "another",
                          calibration.number));
}

Expected<Calibration> calibration_of(const ScanRecord& record,
                                     const std::filesystem::path& calibrations) {
  auto calibration = CalibrationStore(calibrations).load(record.calibration);
  if (!calibration) return calibration;
  const bool is_same = record.calibration_digest.empty() ||  // without a digest, assume the same
                       record.calibration_digest == digest_of(*calibration);
  if (is_same && fits(*calibration, record.camera, record.settings.region)) return calibration;
  return fail(
      ErrorCode::kBadInput,
      fmt::format("calibration {} in {} is not the one that the scan was started with; restore "
                  "that one or start a new scan",
                  record.calibration, calibrations.string()));
}

}  // namespace vitrine::acquisition
