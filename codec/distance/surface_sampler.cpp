// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/surface_sampler.h"

namespace vitrine::inline codec {
namespace {

class SplitMix64 {  // pseudo-random number generator [SLF14]
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  double unit() {  // a random number in [0, 1)
    std::uint64_t z = state_ += 0x9E37'79B9'7F4A'7C15u;
    z = (z ^ z >> 30) * 0xBF58'476D'1CE4'E5B9u;
    z = (z ^ z >> 27) * 0x94D0'49BB'1331'11EBu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

double area(const TrianglePoints& t) {
  return length(cross(t.b - t.a, t.c - t.a)) / 2;
}

Vec3 point_in(const TrianglePoints& t, SplitMix64& random) {
  double u = random.unit(), v = random.unit();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return t.a + (t.b - t.a) * u + (t.c - t.a) * v;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const TriangleBvh& surface, std::size_t count,
                                          std::uint64_t seed) {
  std::vector<SurfaceSample> points;
  if (surface.empty()) return points;
  points.reserve(count);
  double total = 0;
  for (std::uint32_t t = 0; t < surface.size(); ++t)
    total += area(surface.triangle(t));
  SplitMix64 random(seed);
  std::uint32_t i = 0;
  double up_to = area(surface.triangle(0));  // total area of triangles 0 to i
  for (std::size_t k = 0; k < count; ++k) {
    const double at =
        total * ((static_cast<double>(k) + random.unit()) / static_cast<double>(count));
    while (up_to <= at && i + 1 < surface.size())
      up_to += area(surface.triangle(++i));
    points.push_back({point_in(surface.triangle(i), random), i});
  }
  return points;
}

}  // namespace vitrine::inline codec
