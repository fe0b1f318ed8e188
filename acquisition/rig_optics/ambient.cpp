// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "acquisition/rig_optics/light.h"

namespace vitrine::acquisition::rig {
namespace {

// Returns the ambient light that a pixel sees. It comes from all directions, with slightly more
// from the camera's direction.
double ambient_at(const LocalOptics& optics, const PixelRays& rays, const Subject& subject, int u,
                  int v) {
  const Vec3 direction = rays.direction(optics.camera, u, v);
  const auto hit = subject.first_hit(optics.camera.at, direction);
  if (!hit) return kBackground;
  const double facing = std::abs(dot(hit->normal, direction));
  return subject.ambient_light() * hit->albedo * (0.6 + 0.4 * facing);
}

// Fills one row of pixels by interpolating between samples that are `step` pixels apart.
void spread(const std::vector<float>& samples, int step, float* row) {
  for (int first = 0, i = 0; first < kSensorWidth; first += step, ++i) {
    const float from = samples[i], slope = (samples[i + 1] - from) / static_cast<float>(step);
    const int last = std::min(first + step, kSensorWidth);
    for (int u = first; u < last; ++u)
      row[u] = from + slope * static_cast<float>(u - first);
  }
}

}  // namespace

std::vector<float> ambient_light(const LocalOptics& optics, const PixelRays& rays,
                                 const Subject& subject) {
  const int step = subject.ambient_step();
  const int columns = (kSensorWidth - 1) / step + 2;
  const auto sampled = [&](int v) {
    std::vector<float> row;
    for (int i = 0; i < columns; ++i) {
      const int u = std::min(i * step, kSensorWidth - 1);
      row.push_back(
          static_cast<float>(ambient_at(optics, rays, subject, u, std::min(v, kSensorHeight - 1))));
    }
    return row;
  };
  std::vector<float> light(static_cast<std::size_t>(kSensorWidth) * kSensorHeight);
  std::vector<float> upper, lower = sampled(0), between(lower.size());
  for (int v = 0; v < kSensorHeight; ++v) {
    if (v % step == 0) {
      upper.swap(lower);
      lower = sampled(v + step);
    }
    const float t = static_cast<float>(v % step) / static_cast<float>(step);
    for (std::size_t i = 0; i < between.size(); ++i)
      between[i] = upper[i] + t * (lower[i] - upper[i]);
    spread(between, step, light.data() + static_cast<std::ptrdiff_t>(v) * kSensorWidth);
  }
  return light;
}

}  // namespace vitrine::acquisition::rig
