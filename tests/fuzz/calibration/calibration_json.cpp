// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibration_json.h"

#include "fuzz/checks.h"

// An accepted calibration must be usable. Writing and reading it again must not change it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto calibration = vitrine::acquisition::calibration_from_json(text, "input");
  if (!calibration) {
    vitrine::fuzz::require(!calibration.error().message.empty());
    return 0;
  }
  for (double v = 0; v < calibration->region.height; v += 500) {
    if (const auto at = calibration->map.at(500, v))
      vitrine::acquisition::about(calibration->axis, *at);
  }
  const std::string written = vitrine::acquisition::to_json(*calibration);
  const auto again = vitrine::acquisition::calibration_from_json(written, "written");
  vitrine::fuzz::require(again && to_json(*again) == written);
  return 0;
}
