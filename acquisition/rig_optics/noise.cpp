// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/noise.h"

#include <array>
#include <cmath>

namespace vitrine::acquisition::rig {
namespace {

constexpr std::size_t kSteps = 4096;

// Returns quantiles of the normal distribution. Computes each by Newton's method, starting at the
// preceding quantile.
std::array<float, kSteps> quantiles() {
  std::array<double, kSteps> z{};
  double x = 0, squares = 0;
  for (std::size_t i = kSteps / 2; i < kSteps; ++i) {
    const double p = (static_cast<double>(i) + 0.5) / kSteps;
    for (int round = 0; round < 8; ++round) {
      const double density = std::exp(-x * x / 2) * 0.3989422804014327;
      x -= (0.5 * std::erfc(-x * std::sqrt(0.5)) - p) / density;
    }
    z[i] = x;
    z[kSteps - 1 - i] = -x;
    squares += 2 * x * x;
  }
  std::array<float, kSteps> table{};
  const double scale = 1 / std::sqrt(squares / kSteps);
  for (std::size_t i = 0; i < kSteps; ++i)
    table[i] = static_cast<float>(z[i] * scale);
  return table;
}

const std::array<float, kSteps> kNormal = quantiles();

}  // namespace

NormalSequence::NormalSequence(std::uint64_t key, std::uint64_t first)
    : key_(key), index_(first), bits_(scramble(key + first / 4) >> (first % 4 * 16)) {}

float NormalSequence::next() {
  const float value = kNormal[bits_ & (kSteps - 1)];
  bits_ >>= 16;
  if (++index_ % 4 == 0) bits_ = scramble(key_ + index_ / 4);
  return value;
}

float normal(std::uint64_t key, std::uint64_t index) {
  return NormalSequence(key, index).next();
}

}  // namespace vitrine::acquisition::rig
