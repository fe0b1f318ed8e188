// SPDX-License-Identifier: Apache-2.0
// Codes the two ring vertices between which a vertex split cuts the one-ring. A softmax model of
// typical splits, trained online, ranks all pairs. Then one flag per pair is coded, starting with
// the most likely pair, until the pair is found.
#pragma once

#include <array>
#include <cstdint>

#include "codec/core/exact_math.h"
#include "codec/core/limits.h"
#include "codec/core/range_coder.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

// The one-ring of the vertex to split, in an order that encoder and decoder share.
struct RingGeometry {
  std::uint32_t size = 0;
  // Mean distance from the vertex to its ring vertices that are not virtual, at least 0.5.
  double scale = 1;
  std::array<Vec3, kMaxSplitValence> at{};  // positions relative to the vertex
  std::array<bool, kMaxSplitValence> is_virtual{};
  std::array<std::int8_t, kMaxSplitValence> valence{};  // 6 if unknown
};

struct RingCut {
  // The new vertex takes the faces from ring vertex i to ring vertex j, with i < j.
  std::uint32_t i = 0, j = 1;
};

class CutModel {
 public:
  // D = V1 - V2 is the difference of the positions of a split's two vertices. In a regular
  // triangulation, D is this number times the difference of the two arcs' mean positions.
  static constexpr double kArcToEdge = 0.7;

  // Estimates D from the two arcs of the ring, in lattice units.
  static Vec3 estimate(const RingGeometry& ring, const RingCut& cut);

  CutModel();

  template <class Coder>
  RingCut code(Coder& coder, const RingGeometry& ring, RingCut truth) {
    evaluate(ring);
    std::uint32_t wanted = 0;
    if constexpr (Coder::kEncodes) {
      while (candidates_[wanted].cut.i != truth.i || candidates_[wanted].cut.j != truth.j)
        ++wanted;
    }
    const std::uint32_t chosen = pick(coder, wanted);
    learn(chosen);
    return candidates_[chosen].cut;
  }

  static constexpr std::size_t kFeatures = 12;
  static constexpr int kOdds = 28;
  static constexpr std::size_t kBits = 4 * kOdds;
  const std::array<AdaptiveBit, kBits>& bits() const { return bits_; }
  const std::array<double, kFeatures>& weights() const { return weights_; }

 private:
  static constexpr std::size_t kMaxPairs = kMaxSplitValence * (kMaxSplitValence - 1) / 2;
  using Features = std::array<double, kFeatures>;

  struct Candidate {
    RingCut cut;
    Features features{};
  };

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

  std::uint32_t likeliest() const {
    std::uint32_t best = 0;
    double p = 0;
    for (std::uint32_t k = 0; k < count_; ++k) {
      if (probability_[k] > p) best = k, p = probability_[k];
    }
    return best;
  }

  Features weights_;
  std::uint32_t learned_ = 0;
  std::uint32_t count_ = 0;
  // Has one extra entry because candidates are written two at a time.
  std::array<Candidate, kMaxPairs + 1> candidates_;
  // Per candidate: its probability, negated once its flag is coded.
  std::array<double, kMaxPairs + 1> probability_;
  std::array<AdaptiveBit, kBits> bits_;
};

}  // namespace vitrine::inline codec
