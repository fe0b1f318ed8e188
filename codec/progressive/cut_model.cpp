// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/cut_model.h"

#include <algorithm>

#include "codec/progressive/trained_tables.h"

namespace vitrine {
namespace {

constexpr double kNegligible = 1e-3;  // probability of a candidate that learning passes over

// Sums over the real ring vertices before each position, twice round.
struct Prefix {
  explicit Prefix(const CutRing& ring) {
    x[0] = y[0] = z[0] = squares[0] = 0;
    count[0] = 0;
    for (std::uint32_t k = 0; k < 2 * ring.size; ++k) {
      const std::uint32_t m = k < ring.size ? k : k - ring.size;
      const bool real = !ring.is_virtual[m];
      const Vec3& p = ring.at[m];
      x[k + 1] = real ? x[k] + p.x : x[k];
      y[k + 1] = real ? y[k] + p.y : y[k];
      z[k + 1] = real ? z[k] + p.z : z[k];
      squares[k + 1] = real ? squares[k] + dot(p, p) : squares[k];
      count[k + 1] = count[k] + (real ? 1 : 0);
    }
  }
  Vec3 sum(std::uint32_t k) const { return {x[k], y[k], z[k]}; }

  static constexpr std::size_t kSize = 2 * kMaxSplitValence + 1;
  std::array<double, kSize> x, y, z, squares;
  std::array<int, kSize> count;
};

// 1 / n; the quotients are exact roundings, so the table only saves the divisions.
constexpr auto kReciprocal = [] {
  std::array<double, kMaxSplitValence + 2> r{};
  for (std::size_t n = 1; n < r.size(); ++n)
    r[n] = 1.0 / static_cast<double>(n);
  return r;
}();

struct Arc {
  Vec3 mean, sum;
  double squares = 0;
  int count = 0;
};

Arc arc(const Prefix& p, std::uint32_t from, std::uint32_t to) {  // both ends included
  Arc a;
  a.count = p.count[to + 1] - p.count[from];
  a.sum = p.sum(to + 1) - p.sum(from);
  a.squares = p.squares[to + 1] - p.squares[from];
  if (a.count > 0) a.mean = a.sum * kReciprocal[static_cast<std::size_t>(a.count)];
  return a;
}

double square(double x) {
  return x * x;
}

}  // namespace

CutModel::CutModel() {
  std::copy_n(trained::kCutWeights, kFeatures, weights_.begin());
  trained::load(trained::kCutBits, bits_);
}

Vec3 CutModel::estimate(const CutRing& ring, const Cut& cut) {
  Arc near, far;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    if (ring.is_virtual[k]) continue;
    if (k >= cut.i && k <= cut.j) near.sum += ring.at[k], ++near.count;
    if (k <= cut.i || k >= cut.j) far.sum += ring.at[k], ++far.count;
  }
  return (far.sum * (1.0 / std::max(far.count, 1)) - near.sum * (1.0 / std::max(near.count, 1))) *
         kArcToEdge;
}

void CutModel::evaluate(const CutRing& ring) {
  const Prefix prefix(ring);
  const std::uint32_t n = ring.size;
  const double inverse = 1.0 / ring.scale;
  count_ = 0;
  double best = -1e300;
  std::array<double, kMaxSplitValence> reach;
  for (std::uint32_t k = 0; k < n; ++k)
    reach[k] = length(ring.at[k] * inverse);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; ++j) {
      Candidate& c = candidates_[count_];
      c.cut = {i, j};
      const Arc near = arc(prefix, i, j), far = arc(prefix, j, i + n);
      const Vec3 d = (far.mean - near.mean) * (kArcToEdge * inverse);
      const Vec3 l = ring.at[i] * inverse, r = ring.at[j] * inverse;
      const Vec3 chord = r - l, centre = (l + r) * 0.5;
      const double edge = length(d), chord_length = length(chord);
      const double v_valence = static_cast<double>(n - (j - i) + 2) - 6;
      const double w_valence = static_cast<double>(j - i + 2) - 6;
      const double real = near.count + far.count;
      // Squared edge lengths to both arcs once the two vertices stand at +-d/2.
      const double squares = (near.squares + far.squares) * inverse * inverse +
                             dot(d, near.sum - far.sum) * inverse + real * 0.25 * dot(d, d);
      c.features = {(square(v_valence) + square(w_valence)) * 0.1,
                    (ring.valence[i] + ring.valence[j] - 12) * 0.2,
                    edge,
                    edge * edge,
                    chord_length,
                    length(centre),
                    reach[i] + reach[j],
                    std::fabs(dot(chord, d)) / (chord_length * edge + 1e-3),
                    real > 0 ? squares / real : 0.0,
                    ring.is_virtual[i] || ring.is_virtual[j] ? 1.0 : 0.0,
                    chord_length * chord_length,
                    square(reach[i] - reach[j])};
      double s = 0;
      for (std::size_t k = 0; k < kFeatures; ++k)
        s += weights_[k] * c.features[k];
      probability_[count_++] = s;
      best = std::max(best, s);
    }
  }
  double total = 0;
  for (std::uint32_t k = 0; k < count_; ++k) {
    probability_[k] = exact::exp(probability_[k] - best);
    total += probability_[k];
  }
  for (std::uint32_t k = 0; k < count_; ++k)
    probability_[k] /= total;
}

// One step of stochastic gradient ascent on the chosen candidate's log-probability.
void CutModel::learn(std::uint32_t chosen) {
  const double rate = 0.02 + 0.2 / (1 + learned_ * 0.02);
  learned_ = std::min(learned_ + 1, 1u << 20);
  Features mean{};
  for (std::uint32_t k = 0; k < count_; ++k) {
    const double p = std::fabs(probability_[k]);
    if (p < kNegligible) continue;
    for (std::size_t f = 0; f < kFeatures; ++f)
      mean[f] += p * candidates_[k].features[f];
  }
  for (std::size_t f = 0; f < kFeatures; ++f) {
    const double step = rate * (candidates_[chosen].features[f] - mean[f]);
    weights_[f] = std::clamp(weights_[f] + std::clamp(step, -0.5, 0.5), -50.0, 50.0);
  }
}

}  // namespace vitrine
