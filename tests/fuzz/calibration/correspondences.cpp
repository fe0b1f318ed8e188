// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/correspondences.h"

#include <cmath>

#include "fuzz/checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto points = vitrine::acquisition::read_correspondences(text, "input");
  if (!points) return 0;
  for (const vitrine::acquisition::Correspondence& p : *points)
    vitrine::fuzz::require(std::isfinite(p.u) && std::isfinite(p.v) && std::isfinite(p.at.x) &&
                           std::isfinite(p.at.y));
  return 0;
}
