// SPDX-License-Identifier: Apache-2.0
// Codes the two ring vertices between which a vertex split cuts the one-ring. A softmax model,
// trained online on earlier splits, ranks all pairs of ring vertices. Then one flag per pair is
// coded, starting with the most likely pair, until the right pair is found.
#pragma once

#include <array>
#include <cstdint>

#include "codec/core/double2.h"
#include "codec/core/exact_math.h"
#include "codec/core/limits.h"
#include "codec/core/range_coder.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

// The one-ring of the vertex to split. Encoder and decoder list the ring vertices in the same
// order. The arrays have one value per ring vertex; the rest of each array is undefined, because
// clearing it takes longer than filling it.
struct RingGeometry {
  std::uint32_t size = 0;
  // Mean distance from the vertex to its non-virtual ring vertices; at least 0.5.
  double scale = 1;
  // Positions relative to the vertex. They are integers; 0 if the ring vertex is virtual.
  std::array<double, kMaxSplitValence> x, y, z;
  std::array<bool, kMaxSplitValence> is_virtual;
  std::array<std::int8_t, kMaxSplitValence> valence;  // valence of each ring vertex; 6 if unknown

  Vec3 at(std::uint32_t k) const { return {x[k], y[k], z[k]}; }
  void place(std::uint32_t k, const Vec3& p) { x[k] = p.x, y[k] = p.y, z[k] = p.z; }
};

struct RingCut {
  // A cut of the one-ring. The new vertex takes the faces from ring vertex i to ring vertex j, with
  // i < j.
  std::uint32_t i = 0, j = 1;
};

class CutModel {
 public:
  // D = V1 - V2 is the difference of the positions of a split's two vertices. A cut divides the
  // ring into two arcs. In a regular triangulation, D is kArcToEdge times the difference of the
  // mean positions of these arcs.
  static constexpr double kArcToEdge = 0.7;

  // Estimates D from the two arcs of the ring, in lattice units.
  static Vec3 estimate(const RingGeometry& ring, const RingCut& cut);

  CutModel();

  template <class Coder>
  RingCut code(Coder& coder, const RingGeometry& ring, RingCut truth) {
    evaluate(ring);
    std::uint32_t wanted = 0;
    if constexpr (Coder::kEncodes) {
      while (cuts_[wanted].i != truth.i || cuts_[wanted].j != truth.j)
        ++wanted;
    }
    const std::uint32_t chosen = pick(coder, wanted);
    learn(chosen);
    return cuts_[chosen];
  }

  static constexpr std::size_t kFeatures = 12;
  static constexpr int kOdds = 28;
  static constexpr std::size_t kBits = 4 * kOdds;
  const std::array<AdaptiveBit, kBits>& bits() const { return bits_; }
  const std::array<double, kFeatures>& weights() const { return weights_; }

 private:
  // Candidates are scored two at a time: the cuts (i, j) and (i, j + 1). If j is the last ring
  // vertex, the second candidate of the two does not exist; its probability is 0.
  static constexpr std::size_t kMaxTwos = (kMaxSplitValence / 2) * (kMaxSplitValence / 2);
  using TwoFeatures = std::array<Double2, kFeatures>;

  void evaluate(const RingGeometry& ring);
  // Converts the scores in probability_ to probabilities. `best` is the highest score.
  void to_probabilities(double best);
  void learn(std::uint32_t chosen);

  template <class Coder>
  std::uint32_t pick(Coder& coder, std::uint32_t wanted) {
    double left = 1;
    for (std::uint32_t rank = 0;; ++rank) {
      const std::uint32_t best = likeliest();
      if (rank + 1 == count_) return best;
      const double p = probability_[best];
      probability_[best] = -p;
      const double others = std::max(left - p, 1e-9);
      left = others;
      const int odds = std::clamp(exact::log2_bucket<1>(p / others) + 14, 0, kOdds - 1);
      AdaptiveBit& bit = bits_[std::min(rank, 3u) * kOdds + static_cast<std::size_t>(odds)];
      if (coder.bit(bit, best == wanted ? 1 : 0) != 0) return best;
    }
  }

  // Returns the candidate with the highest probability, or the first of several such candidates.
  std::uint32_t likeliest() const {
    Double2 p = both(0), best = both(0), place = {0, 1};
    for (std::uint32_t k = 0; k < slots_; k += 2, place += 2) {
      const Double2 next = load2(&probability_[k]);
      best = next > p ? place : best;
      p = max(next, p);
    }
    const bool second = (p[1] > p[0]) | ((p[1] == p[0]) & (best[1] < best[0]));
    return static_cast<std::uint32_t>(best[second ? 1 : 0]);
  }

  std::array<double, kFeatures> weights_;
  std::uint32_t learned_ = 0;
  std::uint32_t count_ = 0;  // number of candidates
  std::uint32_t slots_ = 0;  // number of candidate slots, including slots without a candidate
  std::array<TwoFeatures, kMaxTwos> features_;
  std::array<RingCut, 2 * kMaxTwos> cuts_;
  // Per candidate: its probability, made negative once the candidate's flag is coded.
  std::array<double, 2 * kMaxTwos> probability_;
  std::array<AdaptiveBit, kBits> bits_;
};

}  // namespace vitrine::inline codec
