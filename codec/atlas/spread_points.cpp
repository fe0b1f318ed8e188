// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/spread_points.h"

#include <cstdint>

namespace vitrine::inline codec {
namespace {

// shortest edge that is left unchanged, and longest move of a point, both in mean edge lengths
constexpr double kShort = 1e-3, kMove = 1e-2;

// Returns a pseudo-random number in [-1, 1], by SplitMix64 [SLF14].
double noise(std::uint64_t seed) {
  std::uint64_t z = (seed + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) / 4503599627370496.0 - 1;
}

template <class Edge>
void each_edge(std::span<const Triangle> faces, const Edge& edge) {
  for (const auto& [a, b, c] : faces)
    edge(a, b), edge(b, c), edge(c, a);
}

}  // namespace

std::vector<Vec3> spread_points(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  std::vector<Vec3> spread(positions.begin(), positions.end());
  double mean = 0;
  each_edge(faces, [&](std::uint32_t a, std::uint32_t b) {
    mean += length(positions[b] - positions[a]) / static_cast<double>(3 * faces.size());
  });
  if (!(mean > 0)) mean = 1;
  std::vector<std::uint8_t> moves(positions.size(), 0);
  each_edge(faces, [&](std::uint32_t a, std::uint32_t b) {
    if (length(positions[b] - positions[a]) < kShort * mean) moves[a] = moves[b] = 1;
  });
  for (std::uint64_t v = 0; v < spread.size(); ++v) {
    if (moves[v])
      spread[v] += Vec3{noise(3 * v), noise(3 * v + 1), noise(3 * v + 2)} * (kMove * mean);
  }
  return spread;
}

}  // namespace vitrine::inline codec
