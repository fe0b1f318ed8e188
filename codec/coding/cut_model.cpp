// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/cut_model.h"

#include <algorithm>

#include "codec/coding/trained_tables.h"
#include "codec/core/double2.h"

namespace vitrine::inline codec {
namespace {

constexpr double kNegligible = 1e-3;  // learn() skips candidates with a lower probability
constexpr double kNoScore = -1e300;   // score of a candidate that does not exist
// Upper limits of the scores of two candidates. Entry 0: both candidates exist. Entry 1: only the
// first candidate exists.
constexpr std::array<Double2, 2> kHighest = {Double2{1e300, 1e300}, Double2{1e300, kNoScore}};

// The values of the ring vertices, one array per kind of value. Values of two consecutive vertices
// are loaded at once, so each array has one extra entry.
struct RingArrays {
  RingArrays(const RingGeometry& ring, double inverse) {
    for (std::uint32_t k = 0; k <= ring.size; ++k) {
      const std::uint32_t m = k < ring.size ? k : 0;
      const Vec3 p = ring.at(m) * inverse;
      x[k] = p.x, y[k] = p.y, z[k] = p.z;
      length[k] = vitrine::length(p);
      valence[k] = ring.valence[m];
      is_virtual[k] = ring.is_virtual[m] ? 1.0 : 0.0;
      real[k] = 1 - is_virtual[k];
      square[k] = dot(ring.at(m), ring.at(m)) * real[k];
      const double v_valence = ring.size - k + 2.0 - 6, w_valence = k + 2.0 - 6;
      valences[k] = (v_valence * v_valence + w_valence * w_valence) * 0.1;
    }
  }

  static constexpr std::size_t kSize = kMaxSplitValence + 1;
  std::array<double, kSize> x, y, z, length, valence, is_virtual;
  // `real` is 1 and `square` is the squared length; both are 0 for a virtual vertex
  std::array<double, kSize> real, square;
  // The value of feature 0, indexed by the number of faces that the new vertex takes.
  std::array<double, kSize> valences;
};

// Prefix sums over the ring, without virtual vertices. The sum over an arc is the difference of two
// prefix sums. All sums are exact, because the positions are integers.
struct PrefixSums {
  PrefixSums(const RingGeometry& ring, const RingArrays& arrays) : size(ring.size) {
    Vec3 sum;
    for (std::uint32_t k = 0; k <= ring.size; ++k) {
      x[k] = sum.x, y[k] = sum.y, z[k] = sum.z;
      count[k] = total_count;
      if (k == ring.size) break;
      if (!ring.is_virtual[k]) sum += ring.at(k), ++total_count;
      squares += arrays.square[k];
    }
    x[size + 1] = y[size + 1] = z[size + 1] = 0;
    count[size + 1] = total_count;
  }

  Vec3 total() const { return {x[size], y[size], z[size]}; }

  static constexpr std::size_t kSize = kMaxSplitValence + 2;
  std::uint32_t size;
  std::array<double, kSize> x, y, z;
  std::array<std::uint32_t, kSize> count;
  std::uint32_t total_count = 0;
  double squares = 0;  // sum of all squared lengths
};

// A table of 1 / n, correctly rounded, which saves divisions. The entry for n = 0 is 0, so that the
// mean of zero values is 0.
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

// Sums and means of the positions on two arcs of the ring. The two arcs share one end.
struct Arcs {
  Arcs(const TwoVec3& sums, std::uint32_t first_count, std::uint32_t second_count)
      : sum(sums), mean(sum * Double2{kReciprocal[first_count], kReciprocal[second_count]}) {}

  TwoVec3 sum, mean;
};

// Returns the two arcs that start at `from`: one ends at `to`, the other at the vertex after `to`.
Arcs arcs_to(const PrefixSums& p, std::uint32_t from, std::uint32_t to) {
  return {two_at(p, to + 1) - twice(at(p, from)), p.count[to + 1] - p.count[from],
          p.count[to + 2] - p.count[from]};
}

// Returns the two arcs that end at `to` after passing the end of the ring: one starts at `from`,
// the other at the vertex after `from`.
Arcs arcs_from(const PrefixSums& p, std::uint32_t from, std::uint32_t to) {
  const std::uint32_t count = p.total_count + p.count[to + 1];
  return {twice(p.total() + at(p, to + 1)) - two_at(p, from), count - p.count[from],
          count - p.count[from + 1]};
}

Double2 square(Double2 x) {
  return x * x;
}

// Computes the features of two cuts: one between ring vertices i and j, the other between i and j +
// 1.
std::array<Double2, CutModel::kFeatures> features_of(const RingArrays& ring, const PrefixSums& sums,
                                                     double inverse, std::uint32_t i,
                                                     std::uint32_t j) {
  const Arcs near = arcs_to(sums, i, j), far = arcs_from(sums, j, i);
  const TwoVec3 d = (far.mean - near.mean) * both(CutModel::kArcToEdge * inverse);
  const TwoVec3 l = twice(at(ring, i)), r = two_at(ring, j);
  const TwoVec3 chord = r - l, centre = (l + r) * both(0.5);
  const Double2 edge = length(d), chord_length = length(chord);
  const Double2 reach = load2(&ring.length[j]);
  // Counts the two ring vertices of the cut twice, because each of them is in both arcs.
  const Double2 real = sums.total_count + ring.real[i] + load2(&ring.real[j]);
  // Sum of the squared lengths of the edges from the split's two vertices to the ring vertices of
  // their arcs. The two vertices lie at +d/2 and -d/2.
  const Double2 squares =
      (sums.squares + ring.square[i] + load2(&ring.square[j])) * inverse * inverse +
      dot(d, near.sum - far.sum) * inverse + real * 0.25 * dot(d, d);
  return {load2(&ring.valences[j - i]),
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
  const auto add = [&](auto& arc, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t k = from; k < to; ++k) {
      if (!ring.is_virtual[k]) arc.sum += ring.at(k), ++arc.count;
    }
  };
  add(near, cut.i, cut.j + 1);
  add(far, 0, cut.i + 1);
  add(far, cut.j, ring.size);
  return (far.sum * (1.0 / std::max(far.count, 1)) - near.sum * (1.0 / std::max(near.count, 1))) *
         kArcToEdge;
}

// Computes the features and the probability of each cut. Handles two cuts at a time, which start at
// the same ring vertex.
void CutModel::evaluate(const RingGeometry& ring) {
  const double inverse = 1.0 / ring.scale;
  const RingArrays arrays(ring, inverse);
  const PrefixSums sums(ring, arrays);
  TwoFeatures weights;
  std::transform(weights_.begin(), weights_.end(), weights.begin(), both);
  const std::uint32_t n = ring.size;
  count_ = n * (n - 1) / 2;
  slots_ = 0;
  Double2 best = both(kNoScore);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; j += 2, slots_ += 2) {
      TwoFeatures& features = features_[slots_ / 2];
      features = features_of(arrays, sums, inverse, i, j);
      Double2 score = both(0);
      for (std::size_t k = 0; k < kFeatures; ++k)
        score += weights[k] * features[k];
      const Double2 highest = kHighest[j + 1 == n ? 1 : 0];
      score = score < highest ? score : highest;
      best = max(best, score);
      store2(&probability_[slots_], score);
      cuts_[slots_] = {i, j};
      cuts_[slots_ + 1] = {i, j + 1};
    }
  }
  to_probabilities(std::max(best[0], best[1]));
}

void CutModel::to_probabilities(double best) {
  double total = 0;
  for (std::uint32_t k = 0; k < slots_; k += 2) {
    const Double2 score = load2(&probability_[k]);
    const Double2 odds = score > kNoScore ? exact::exp_of_negative(score - best) : both(0);
    store2(&probability_[k], odds);
    total += odds[0];
    total += odds[1];
  }
  for (std::uint32_t k = 0; k < slots_; k += 2)
    store2(&probability_[k], load2(&probability_[k]) / total);
}

// Takes one step of stochastic gradient ascent on the log-probability of the candidate `chosen`.
void CutModel::learn(std::uint32_t chosen) {
  const double rate = 0.02 + 0.2 / (1 + learned_ * 0.02);
  learned_ = std::min(learned_ + 1, 1u << 20);
  // Features 2f and 2f + 1 of candidate k.
  const auto features = [&](std::uint32_t k, std::size_t f) {
    return Double2{features_[k / 2][2 * f][k % 2], features_[k / 2][2 * f + 1][k % 2]};
  };
  // Collects the candidates without a branch, because a branch here is often mispredicted.
  std::array<std::uint32_t, 2 * kMaxTwos> likely;
  std::uint32_t likely_count = 0;
  for (std::uint32_t k = 0; k < slots_; ++k) {
    likely[likely_count] = k;
    likely_count += std::fabs(probability_[k]) >= kNegligible ? 1 : 0;
  }
  std::array<Double2, kFeatures / 2> mean;
  mean.fill(both(0));
  for (std::uint32_t m = 0; m < likely_count; ++m) {
    const double p = std::fabs(probability_[likely[m]]);
    for (std::size_t f = 0; f < mean.size(); ++f)
      mean[f] += p * features(likely[m], f);
  }
  for (std::size_t f = 0; f < mean.size(); ++f) {
    const Double2 step = clamp(rate * (features(chosen, f) - mean[f]), -0.5, 0.5);
    store2(&weights_[2 * f], clamp(load2(&weights_[2 * f]) + step, -50.0, 50.0));
  }
}

}  // namespace vitrine::inline codec
