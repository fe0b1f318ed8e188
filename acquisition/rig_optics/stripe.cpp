// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>

#include "acquisition/rig_optics/light.h"
#include "acquisition/rig_optics/noise.h"
#include "acquisition/rig_optics/stripe_band.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr double kPeak = 185;  // grey level of a white surface that faces the laser
// Distance from the middle of the sheet at which its light ends, in standard deviations of its
// profile.
constexpr double kReach = 3.4;
constexpr double kShine = 40;  // exponent of the specular lobe
// Number of rays that are cast side by side for each pixel. One is not enough, because on steep
// parts the stripe is narrower than a pixel.
constexpr int kSub = 3;
constexpr int kTaps = 4;  // rays on either side that the blur includes

// Returns the sheet's light at a distance `d`, in standard deviations, from its middle. The maximum
// is 1.
double profile(StripeShape shape, double d) {
  if (shape == StripeShape::kTopHat) return std::abs(d) < 1.6 ? 1 : 0;
  if (shape == StripeShape::kSkewed) d *= d < 0 ? 1.4 : 0.8;
  return std::exp(-d * d / 2);
}

double mirrored(const RayHit& hit, const Vec3& to_light, const Vec3& to_camera) {
  const Vec3 back = hit.normal * (2 * dot(hit.normal, to_light)) - to_light;
  const double along = dot(back, to_camera);
  return along > 0 ? std::pow(along, kShine) : 0;
}

class Stripe {
 public:
  Stripe(const LocalOptics& optics, const PixelRays& rays, const Subject& subject,
         const LaserLook& look)
      : optics_(optics), rays_(rays), subject_(subject), look_(look) {}

  double at(double u, int v) const {
    const Vec3 direction = rays_.direction(optics_.camera, u, v);
    const auto hit = subject_.first_hit(optics_.camera.at, direction);
    return hit ? reflected(*hit, direction * -1) : 0;
  }

 private:
  double reflected(const RayHit& hit, const Vec3& to_camera) const {
    const LaserSheet& laser = optics_.laser;
    const double d = (dot(laser.normal, hit.at) - laser.offset) / laser.sigma;
    if (std::abs(d) > kReach) return 0;
    const Vec3 way = laser.source - hit.at;
    const double distance = length(way);
    const Vec3 to_light = way * (1 / distance);
    const double facing = dot(hit.normal, to_light);
    if (facing * dot(hit.normal, to_camera) <= 0)
      return 0;  // the laser lights the surface from behind
    const double sheet = profile(look_.shape, d);
    if (sheet == 0 || subject_.shadowed(hit, laser.source)) return 0;
    // The light of a fan decreases with distance. The factor is 1 at 340 mm, the approximate
    // distance of the table.
    return kPeak * sheet * std::abs(facing) * (340 / distance) *
           (hit.albedo + hit.gloss * 3 * mirrored(hit, to_light, to_camera));
  }

  const LocalOptics& optics_;
  const PixelRays& rays_;
  const Subject& subject_;
  const LaserLook& look_;
};

// Returns the weights of a blur along a row, at rays a third of a pixel apart. The blur combines
// the lens (half a pixel) with the width of a pixel.
std::array<double, 2 * kTaps + 1> blur_weights() {
  std::array<double, 2 * kTaps + 1> weights{};
  double sum = 0;
  double k = -kTaps;
  for (double& weight : weights) {
    for (const double shift : {-1.0, 0.0, 1.0}) {
      const double pixels = (k + shift) / kSub;
      weight += std::exp(-pixels * pixels / (2 * 0.5 * 0.5));
    }
    sum += weight;
    ++k;
  }
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

// Adds the light of one run of pixels, blurred along the row, to `row`. The outermost pixels of the
// run receive light from the blur only.
void add_run(const Stripe& stripe, const PixelRun& run, int v, std::vector<double>& fine,
             float* row) {
  static const auto kWeights = blur_weights();
  fine.clear();
  for (int i = run.first * kSub - kTaps; i <= run.last * kSub + kTaps; ++i) {
    const bool lit = i >= (run.first + 1) * kSub - 1 && i <= (run.last - 1) * kSub + 1;
    fine.push_back(lit ? stripe.at(static_cast<double>(i) / kSub, v) : 0);
  }
  for (int u = run.first; u <= run.last; ++u) {
    double sum = 0;
    for (std::size_t k = 0; k < kWeights.size(); ++k)
      sum += kWeights[k] * fine[static_cast<std::size_t>((u - run.first) * kSub) + k];
    row[u] = static_cast<float>(sum);
  }
}

// Speckle with a mean of 1, correlated over about 1.5 pixels. Its distribution is log-normal, so it
// is never negative.
class Speckle {
 public:
  Speckle(double contrast, std::uint64_t key) : key_(key) {
    const double variance = std::log(1 + contrast * contrast);
    constexpr double kSpread = 1 + 2 * kSide * kSide;
    // Compensates for the blur in both directions, which multiplies the variance by the square of
    // kSpread.
    scale_ = std::sqrt(variance) / kSpread;
    shift_ = -variance / 2;
  }

  float at(int u, int v) const {
    double sum = 0;
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i)
        sum += (i == 0 ? 1 : kSide) * (j == 0 ? 1 : kSide) * grain(u + i, v + j);
    }
    return static_cast<float>(std::exp(scale_ * sum + shift_));
  }

 private:
  double grain(int u, int v) const {
    return normal(key_, static_cast<std::uint64_t>(v + 1) * (kSensorWidth + 8) +
                            static_cast<std::uint64_t>(u + 4));
  }

  static constexpr double kSide = 0.35;
  std::uint64_t key_;
  double scale_ = 0, shift_ = 0;
};

// Blurs three rows into one, to simulate the lens's blur across rows.
void blur_down(const std::vector<float>& above, const std::vector<float>& here,
               const std::vector<float>& below, float* out) {
  constexpr float kAside = 0.107F;
  for (std::size_t u = 0; u < here.size(); ++u)
    out[u] = (1 - 2 * kAside) * here[u] + kAside * (above[u] + below[u]);
}

void add_speckle(const Speckle& speckle, const std::vector<PixelRun>& runs, int v, float* row) {
  for (const PixelRun& run : runs) {
    for (int u = run.first; u <= run.last; ++u) {
      if (row[u] > 0) row[u] *= speckle.at(u, v);
    }
  }
}

}  // namespace

std::vector<float> stripe_light(const LocalOptics& optics, const PixelRays& rays,
                                const Subject& subject, const LaserLook& look, std::uint64_t key) {
  const auto band = stripe_band(optics, subject, kReach * optics.laser.sigma);
  const Stripe stripe(optics, rays, subject, look);
  const Speckle speckle(look.speckle, key);
  std::vector<double> fine;
  const auto sharp = [&](std::size_t v) {
    std::vector<float> row(kSensorWidth);
    if (v < band.size()) {
      for (const PixelRun& run : band[v])
        add_run(stripe, run, static_cast<int>(v), fine, row.data());
    }
    return row;
  };
  std::vector<float> light(static_cast<std::size_t>(kSensorWidth) * kSensorHeight);
  std::vector<float> above(kSensorWidth), here = sharp(0);
  for (std::size_t v = 0; v < band.size(); ++v) {
    std::vector<float> below = sharp(v + 1);
    float* out = light.data() + v * kSensorWidth;
    blur_down(above, here, below, out);
    if (look.speckle > 0) add_speckle(speckle, band[v], static_cast<int>(v), out);
    above = std::exchange(here, std::move(below));
  }
  return light;
}

}  // namespace vitrine::acquisition::rig
