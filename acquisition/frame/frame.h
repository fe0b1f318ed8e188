// SPDX-License-Identifier: Apache-2.0
// A camera picture, and positions in it. In pixel coordinates, u points to the right and v down.
// The centre of the top left pixel is (0, 0).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vitrine::acquisition {

// A monochrome picture with 8 bits per pixel, row by row without gaps. pixels.size() is therefore
// width * height.
struct Frame {
  int width = 0, height = 0;  // size of the region that was read, in pixels
  std::vector<std::uint8_t> pixels;

  std::span<const std::uint8_t> row(int v) const {
    return {pixels.data() + static_cast<std::size_t>(v) * width, static_cast<std::size_t>(width)};
  }
  bool operator==(const Frame&) const = default;
};

// A position in a picture, to sub-pixel precision.
struct ImagePoint {
  double u = 0, v = 0;  // in pixels from the centre of the top left pixel
};

// The part of the sensor that is read. A calibration is valid for one region of one camera.
struct SensorRegion {
  int x = 0, y = 0, width = 0, height = 0;  // pixels of the sensor

  bool operator==(const SensorRegion&) const = default;
};

}  // namespace vitrine::acquisition
