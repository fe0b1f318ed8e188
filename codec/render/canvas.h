// SPDX-License-Identifier: Apache-2.0
// Rasterises triangles. First finds the face that is visible at each sample. Then shades each
// sample once and averages the samples of each pixel.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "codec/core/srgb.h"
#include "codec/picture/picture.h"
#include "codec/render/screen_triangle.h"

namespace vitrine::inline codec {

inline constexpr std::uint32_t kSamples = 3;  // samples per pixel on each axis

// Position of a sample, counted from the picture's top left corner.
struct SamplePosition {
  std::uint32_t x, y;
};

class Canvas {
 public:
  // `width` and `height` are in pixels.
  Canvas(std::uint32_t width, std::uint32_t height)
      : width_(width * kSamples),
        height_(height * kSamples),
        samples_(std::size_t{width_} * height_) {}

  // Draws a face at the samples where `is_solid(Barycentric, SamplePosition)` is true and the face
  // is nearer to the eye than all faces drawn before. `face` must be below 2^32 - 1.
  template <class IsSolid>
  void draw(std::uint32_t face, const ScreenTriangle& triangle, IsSolid is_solid) {
    if (triangle.signed_area() == 0) return;
    const auto [left, right] = triangle.columns(width_);
    const auto [top, bottom] = triangle.rows(height_);
    for (std::uint32_t y = top; y < bottom; ++y) {
      for (std::uint32_t x = left; x < right; ++x)
        draw_sample(face, triangle, {x, y}, is_solid);
    }
  }

  // Returns the picture, with a transparent background. `shade(face, SamplePosition)` returns a
  // sample's colour in linear light, as a Vec3.
  template <class Shade>
  Picture develop(Shade shade) const {
    Picture picture{width_ / kSamples, height_ / kSamples, {}};
    picture.pixels.reserve(4 * std::size_t{picture.width} * picture.height);
    for (std::uint32_t y = 0; y < height_; y += kSamples) {
      for (std::uint32_t x = 0; x < width_; x += kSamples)
        add_pixel(picture, {x, y}, shade);
    }
    return picture;
  }

 private:
  static constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

  struct Sample {
    float depth = -std::numeric_limits<float>::infinity();
    std::uint32_t face = kNoFace;
  };

  template <class IsSolid>
  void draw_sample(std::uint32_t face, const ScreenTriangle& triangle, SamplePosition at,
                   IsSolid& is_solid) {
    const Barycentric weights = triangle.at(at.x, at.y);
    if (!weights.is_inside()) return;
    Sample& sample = samples_[std::size_t{at.y} * width_ + at.x];
    const auto& [a, b, c] = triangle.corners();
    const auto depth = static_cast<float>(weights.u * a.z + weights.v * b.z + weights.w * c.z);
    if (depth <= sample.depth || !is_solid(weights, at)) return;
    sample = {depth, face};
  }

  template <class Shade>
  void add_pixel(Picture& picture, SamplePosition first, Shade& shade) const {
    std::array<double, 3> sum{};
    std::uint32_t covered = 0;
    for (std::uint32_t y = first.y; y < first.y + kSamples; ++y) {
      for (std::uint32_t x = first.x; x < first.x + kSamples; ++x) {
        const std::uint32_t face = samples_[std::size_t{y} * width_ + x].face;
        if (face == kNoFace) continue;
        ++covered;
        add(sum, shade(face, SamplePosition{x, y}));
      }
    }
    for (const double s : sum) {
      const double mean = covered == 0 ? 0 : std::min(1.0, s / covered);
      picture.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(mean))));
    }
    picture.pixels.push_back(static_cast<std::uint8_t>(255 * covered / (kSamples * kSamples)));
  }

  static void add(std::array<double, 3>& sum, const Vec3& light) {
    sum[0] += static_cast<float>(light.x);
    sum[1] += static_cast<float>(light.y);
    sum[2] += static_cast<float>(light.z);
  }

  std::uint32_t width_, height_;
  std::vector<Sample> samples_;
};

}  // namespace vitrine::inline codec
