// SPDX-License-Identifier: Apache-2.0
#include "codec/render/mip_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/core/srgb.h"
#include "codec/picture/pixel_pair.h"

namespace vitrine::inline codec {
namespace {

const ByteValues& values_of_bytes(PictureCoding coding) {
  const auto make = [](auto value) {
    ByteValues values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(value(static_cast<double>(i) / 255));
    return values;
  };
  static const ByteValues srgb = make(srgb_to_linear), plain = make([](double v) { return v; });
  return coding == PictureCoding::kSrgb ? srgb : plain;
}

// Returns the sRGB byte of a linear value in [0, 1]. The table has 2^16 entries, so that the byte
// value before rounding is off by at most 0.03.
std::uint8_t srgb_byte(float value) {
  static const auto table = [] {
    std::vector<std::uint8_t> bytes(65536);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>(
          std::lround(255 * linear_to_srgb(static_cast<double>(i) / 65535)));
    return bytes;
  }();
  return table[static_cast<std::size_t>(value * 65535 + 0.5f)];
}

inline void add(Texel& sum, const std::uint8_t* pixel, const ByteValues& colours, float weight) {
  sum[0] += weight * colours[pixel[0]];
  sum[1] += weight * colours[pixel[1]];
  sum[2] += weight * colours[pixel[2]];
  sum[3] += weight / 255 * static_cast<float>(pixel[3]);
}

void append(std::vector<std::uint8_t>& pixels, const Texel& texel, PictureCoding coding) {
  const auto byte = [&](std::size_t c) {
    const float value = std::clamp(texel[c], 0.0f, 1.0f);
    const bool is_plain = c == 3 || coding == PictureCoding::kValues;
    return is_plain ? static_cast<std::uint8_t>(255 * value + 0.5f) : srgb_byte(value);
  };
  pixels.insert(pixels.end(), {byte(0), byte(1), byte(2), byte(3)});
}

// The pixels of one level that a pixel of the next level covers along one axis, and the weight of
// each.
struct BoxFilter {
  std::uint32_t first, count;
  std::array<float, 3> weights;
};

BoxFilter box_filter(std::uint32_t i, std::uint32_t size) {
  if (size == 1) return {0, 1, {1}};
  if (size % 2 == 0) return {2 * i, 2, {0.5f, 0.5f}};
  // A pixel of the next level covers 2 pixels of this level, or 2 + 1 / half if `size` is odd.
  const std::uint32_t half = size / 2;
  const auto share = [&](std::uint32_t parts) {
    return static_cast<float>(parts) / static_cast<float>(size);
  };
  return {2 * i, 3, {share(half - i), share(half), share(i + 1)}};
}

Texel box_mean(const Picture& picture, const BoxFilter& x, const BoxFilter& y,
               const ByteValues& colours) {
  Texel sum{};
  for (std::uint32_t row = 0; row < y.count; ++row) {
    const std::size_t start = std::size_t{y.first + row} * picture.width + x.first;
    for (std::uint32_t column = 0; column < x.count; ++column)
      add(sum, &picture.pixels[4 * (start + column)], colours, x.weights[column] * y.weights[row]);
  }
  return sum;
}

Picture halved(const Picture& picture, PictureCoding coding) {
  const ByteValues& colours = values_of_bytes(coding);
  Picture half{std::max(1u, picture.width / 2), std::max(1u, picture.height / 2), {}};
  half.pixels.reserve(4 * std::size_t{half.width} * half.height);
  for (std::uint32_t y = 0; y < half.height; ++y) {
    const BoxFilter rows = box_filter(y, picture.height);
    for (std::uint32_t x = 0; x < half.width; ++x)
      append(half.pixels, box_mean(picture, box_filter(x, picture.width), rows, colours), coding);
  }
  return half;
}

}  // namespace

MipMap::MipMap(const Picture& picture, PictureCoding coding)
    : colours_(&values_of_bytes(coding)), levels_{&picture} {
  for (const Picture* last = &picture; last->width > 1 || last->height > 1; last = &smaller_.back())
    smaller_.push_back(halved(*last, coding));
  for (const Picture& level : smaller_)
    levels_.push_back(&level);
}

Texel MipMap::interpolated(std::size_t level, const TextureCoordinates& uv, Wrap wrap_u,
                           Wrap wrap_v) const {
  const Picture& picture = *levels_[level];
  const PixelPair x = pixels_around(uv[0], picture.width, wrap_u),
                  y = pixels_around(uv[1], picture.height, wrap_v);
  Texel sum{};
  const auto add_row = [&](std::uint32_t row, double weight) {
    const std::uint8_t* pixels = &picture.pixels[4 * std::size_t{row} * picture.width];
    add(sum, pixels + 4 * std::size_t{x.first}, *colours_,
        static_cast<float>(weight * (1 - x.weight)));
    add(sum, pixels + 4 * std::size_t{x.second}, *colours_, static_cast<float>(weight * x.weight));
  };
  add_row(y.first, 1 - y.weight);
  add_row(y.second, y.weight);
  return sum;
}

Texel MipMap::at(const TextureCoordinates& uv, double level, Wrap wrap_u, Wrap wrap_v) const {
  const double clamped = std::min(std::max(0.0, level), static_cast<double>(levels_.size() - 1));
  const auto finer = static_cast<std::size_t>(clamped);
  const auto share = static_cast<float>(clamped - static_cast<double>(finer));
  Texel texel = interpolated(finer, uv, wrap_u, wrap_v);
  if (share == 0) return texel;
  const Texel coarser = interpolated(finer + 1, uv, wrap_u, wrap_v);
  for (std::size_t c = 0; c < texel.size(); ++c)
    texel[c] += share * (coarser[c] - texel[c]);
  return texel;
}

Texel MipMap::nearest(const TextureCoordinates& uv, Wrap wrap_u, Wrap wrap_v) const {
  const Picture& picture = *levels_[0];
  const std::size_t row = pixel_at(uv[1], picture.height, wrap_v);
  const std::size_t at = row * picture.width + pixel_at(uv[0], picture.width, wrap_u);
  Texel texel{};
  add(texel, &picture.pixels[4 * at], *colours_, 1);
  return texel;
}

}  // namespace vitrine::inline codec
