// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/cut_model.h"

#include <algorithm>

#include "codec/coding/trained_tables.h"
#include "codec/core/double2.h"

namespace vitrine::inline codec {
namespace {

constexpr double kNegligible = 1e-3;  // learning skips candidates with a lower probability

// The ring vertices as arrays, from which the data of two consecutive vertices is loaded at once.
// Each array has one extra entry, so that the last load stays inside it.
struct RingArrays {
  RingArrays(const RingGeometry& ring, double inverse) {
    for (std::uint32_t k = 0; k <= ring.size; ++k) {
      const std::uint32_t m = k < ring.size ? k : 0;
      const Vec3 p = ring.at[m] * inverse;
      x[k] = p.x, y[k] = p.y, z[k] = p.z;
      length[k] = vitrine::length(p);
      valence[k] = ring.valence[m];
      is_virtual[k] = ring.is_virtual[m] ? 1.0 : 0.0;
    }
  }

  static constexpr std::size_t kSize = kMaxSplitValence + 1;
  std::array<double, kSize> x, y, z, length, valence, is_virtual;
};

// Prefix sums over the ring vertices, going twice around the ring. Virtual vertices are left out.
struct PrefixSums {
  explicit PrefixSums(const RingGeometry& ring) {
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

  static constexpr std::size_t kSize = 2 * kMaxSplitValence + 1;
  std::array<double, kSize> x, y, z, squares;
  std::array<int, kSize> count;
};

// A table of 1 / n, correctly rounded, which saves divisions. The entry for n = 0 is 0, so that the
// mean of no values is zero.
constexpr auto kReciprocal = [] {
  std::array<double, kMaxSplitValence + 2> r{};
  for (std::size_t n = 1; n < r.size(); ++n)
    r[n] = 1.0 / static_cast<double>(n);
  return r;
}();

struct TwoVec3 {
  Double2 x, y, z;

  TwoVec3 operator+(const TwoVec3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  TwoVec3 operator-(const TwoVec3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  TwoVec3 operator*(Double2 s) const { return {x * s, y * s, z * s}; }
};

Double2 dot(const TwoVec3& a, const TwoVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Double2 length(const TwoVec3& a) {
  return sqrt(dot(a, a));
}
TwoVec3 twice(const Vec3& v) {
  return {both(v.x), both(v.y), both(v.z)};
}
template <class Arrays>
Vec3 at(const Arrays& a, std::uint32_t k) {
  return {a.x[k], a.y[k], a.z[k]};
}
template <class Arrays>
TwoVec3 two_at(const Arrays& a, std::uint32_t k) {
  return {load2(&a.x[k]), load2(&a.y[k]), load2(&a.z[k])};
}

// Sums over two arcs of the ring that have one end in common.
struct Arcs {
  TwoVec3 sum, mean;
  Double2 squares, count;

  void count_up(int a, int b) {
    count = Double2{static_cast<double>(a), static_cast<double>(b)};
    mean = sum * Double2{kReciprocal[static_cast<std::size_t>(a)],
                         kReciprocal[static_cast<std::size_t>(b)]};
  }
};

// Returns the sums over two arcs that start at `from`: one ends at `to`, the other at the vertex
// after `to`.
Arcs arcs_to(const PrefixSums& p, std::uint32_t from, std::uint32_t to) {
  Arcs a;
  a.sum = two_at(p, to + 1) - twice(at(p, from));
  a.squares = load2(&p.squares[to + 1]) - p.squares[from];
  a.count_up(p.count[to + 1] - p.count[from], p.count[to + 2] - p.count[from]);
  return a;
}

// Returns the sums over two arcs that end at `to`: one starts at `from`, the other at the vertex
// after `from`.
Arcs arcs_from(const PrefixSums& p, std::uint32_t from, std::uint32_t to) {
  Arcs a;
  a.sum = twice(at(p, to + 1)) - two_at(p, from);
  a.squares = p.squares[to + 1] - load2(&p.squares[from]);
  a.count_up(p.count[to + 1] - p.count[from], p.count[to + 1] - p.count[from + 1]);
  return a;
}

Double2 square(Double2 x) {
  return x * x;
}

using TwoFeatures = std::array<Double2, CutModel::kFeatures>;

// Computes the features of the cuts (i, j) and (i, j + 1).
TwoFeatures features_of(const RingArrays& ring, const PrefixSums& sums, std::uint32_t n,
                        double inverse, std::uint32_t i, std::uint32_t j) {
  const Arcs near = arcs_to(sums, i, j), far = arcs_from(sums, j, i + n);
  const TwoVec3 d = (far.mean - near.mean) * both(CutModel::kArcToEdge * inverse);
  const TwoVec3 l = twice(at(ring, i)), r = two_at(ring, j);
  const TwoVec3 chord = r - l, centre = (l + r) * both(0.5);
  const Double2 edge = length(d), chord_length = length(chord);
  const Double2 reach = load2(&ring.length[j]);
  const Double2 taken = both(j - i) + Double2{0, 1};
  const Double2 v_valence = n - taken + 2 - 6, w_valence = taken + 2 - 6;
  const Double2 real = near.count + far.count;
  // Sum of the squared lengths of the edges to both arcs, with the two vertices at +-d/2.
  const Double2 squares = (near.squares + far.squares) * inverse * inverse +
                          dot(d, near.sum - far.sum) * inverse + real * 0.25 * dot(d, d);
  return {(square(v_valence) + square(w_valence)) * 0.1,
          (ring.valence[i] + load2(&ring.valence[j]) - 12) * 0.2,
          edge,
          edge * edge,
          chord_length,
          length(centre),
          ring.length[i] + reach,
          abs(dot(chord, d)) / (chord_length * edge + 1e-3),
          real > 0 ? squares / real : both(0),
          max(both(ring.is_virtual[i]), load2(&ring.is_virtual[j])),
          chord_length * chord_length,
          square(ring.length[i] - reach)};
}

}  // namespace

CutModel::CutModel() {
  static const auto kStart = trained::numbers_of<kFeatures>(trained::kCutWeights);
  weights_ = kStart;
  trained::load(trained::kCutBits, bits_);
}

Vec3 CutModel::estimate(const RingGeometry& ring, const RingCut& cut) {
  struct {
    Vec3 sum;
    int count = 0;
  } near, far;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    if (ring.is_virtual[k]) continue;
    if (k >= cut.i && k <= cut.j) near.sum += ring.at[k], ++near.count;
    if (k <= cut.i || k >= cut.j) far.sum += ring.at[k], ++far.count;
  }
  return (far.sum * (1.0 / std::max(far.count, 1)) - near.sum * (1.0 / std::max(near.count, 1))) *
         kArcToEdge;
}

// Computes the features and the probability of each cut. Handles two cuts with the same first ring
// vertex at a time.
void CutModel::evaluate(const RingGeometry& ring) {
  const double inverse = 1.0 / ring.scale;
  const RingArrays arrays(ring, inverse);
  const PrefixSums sums(ring);
  const std::uint32_t n = ring.size;
  count_ = 0;
  Double2 best = both(-1e300);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; j += 2) {
      const TwoFeatures features = features_of(arrays, sums, n, inverse, i, j);
      Double2 score = both(0);
      for (std::size_t k = 0; k < kFeatures; ++k)
        score += weights_[k] * features[k];
      const bool second = j + 1 < n;
      if (!second) score[1] = score[0];
      best = max(best, score);
      store2(&probability_[count_], score);
      Candidate* const candidate = &candidates_[count_];
      candidate[0].cut = {i, j};
      candidate[1].cut = {i, j + 1};
      for (std::size_t k = 0; k < kFeatures; k += 2) {
        const Double2 a = features[k], b = features[k + 1];
        store2(&candidate[0].features[k], Double2{a[0], b[0]});
        store2(&candidate[1].features[k], Double2{a[1], b[1]});
      }
      count_ += second ? 2 : 1;
    }
  }
  to_probabilities(std::max(best[0], best[1]));
}

void CutModel::to_probabilities(double best) {
  for (std::uint32_t k = 0; k < count_; k += 2)
    store2(&probability_[k], exact::exp_of_negative(load2(&probability_[k]) - best));
  double total = 0;
  for (std::uint32_t k = 0; k < count_; ++k)
    total += probability_[k];
  for (std::uint32_t k = 0; k < count_; k += 2)
    store2(&probability_[k], load2(&probability_[k]) / total);
}

// Takes one step of stochastic gradient ascent on the log-probability of the chosen candidate.
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

}  // namespace vitrine::inline codec
