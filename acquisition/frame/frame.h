// SPDX-License-Identifier: Apache-2.0
// What the camera delivers. Pixel coordinates: u to the right, v down, whole numbers at the centres
// of pixels, (0, 0) that of the top left one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vitrine {

// Monochrome, 8 bits a pixel, row after row without gaps: pixels.size() == width * height.
struct Frame {
  int width = 0, height = 0;  // pixels, of the region that was read
  std::vector<std::uint8_t> pixels;

  std::span<const std::uint8_t> row(int v) const {
    return {pixels.data() + static_cast<std::size_t>(v) * width, static_cast<std::size_t>(width)};
  }
  bool operator==(const Frame&) const = default;
};

// The part of the sensor that is read. A calibration belongs to one region of one camera.
struct SensorRegion {
  int x = 0, y = 0, width = 0, height = 0;  // pixels of the sensor

  bool operator==(const SensorRegion&) const = default;
};

}  // namespace vitrine
