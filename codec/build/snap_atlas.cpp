// SPDX-License-Identifier: Apache-2.0
#include "codec/build/snap_atlas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vitrine::inline codec {
namespace {

// Minimum number of lattice steps per edge of mean length.
constexpr double kStepsPerEdge = 32;
// Largest step in coordinate units: a quarter of the least distance between charts.
constexpr std::int32_t kLargestStep = 1024;
// Every face must have a quality() above this.
constexpr double kGood = 0.5;
constexpr int kMendingSweeps = 8;
constexpr std::int32_t kReach = 2;  // how far mend() moves a wedge along each axis, in steps

double mean_edge(std::span<const Triangle> faces, std::span<const Vec2> at) {
  double sum = 0;
  for (const auto& [a, b, c] : faces) {
    for (const Vec2& edge : {at[b] - at[a], at[c] - at[b], at[a] - at[c]})
      sum += std::sqrt(dot(edge, edge));
  }
  return faces.empty() ? 0 : sum / static_cast<double>(3 * faces.size());
}

// Rounds coordinates to the lattice with a given step.
class Snapping {
 public:
  Snapping(std::span<const Triangle> faces, std::span<const Vec2> exact, std::int32_t step)
      : faces_(faces), exact_(exact), step_(step), faces_at_(exact.size()) {
    for (const Vec2& p : exact)
      at_.push_back(rounded(p));
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (const std::uint32_t w : faces[f])
        faces_at_[w].push_back(f);
    }
  }

  // Moves wedges until every face has a quality() above kGood. Returns false if that fails. Without
  // this check, a lattice that was too coarse for one scan left its packed picture almost empty.
  bool mend() {
    for (int sweep = 0; sweep < kMendingSweeps; ++sweep) {
      bool is_good = true;
      for (std::uint32_t w = 0; w < at_.size(); ++w) {
        if (quality_at(w) > kGood) continue;
        is_good = false;
        improve(w);
      }
      if (is_good) return true;
    }
    return false;
  }

  std::vector<Vec2i> take() { return std::move(at_); }

 private:
  Vec2i rounded(const Vec2& p) const {
    return {static_cast<std::int32_t>(std::lround(p.x / step_)) * step_,
            static_cast<std::int32_t>(std::lround(p.y / step_)) * step_};
  }

  // Compares a face's area before rounding with its area after rounding: returns the smaller
  // divided by the larger. The result is not positive if rounding has flipped the face. Returns 1
  // for a face that was flipped before rounding.
  double quality(std::size_t f) const {
    const auto& [a, b, c] = faces_[f];
    const double before = cross(exact_[b] - exact_[a], exact_[c] - exact_[a]);
    if (!(before > 0)) return 1;
    const double now = cross(to_vec2(at_[b] - at_[a]), to_vec2(at_[c] - at_[a]));
    return now > before ? before / now : now / before;
  }
  double quality_at(std::uint32_t w) const {
    double least = 1;
    for (const std::size_t f : faces_at_[w])
      least = std::min(least, quality(f));
    return least;
  }

  // Moves a wedge to the nearby lattice point at which the worst of its faces has the best
  // quality().
  void improve(std::uint32_t w) {
    const Vec2i middle = rounded(exact_[w]);
    Vec2i best = at_[w];
    double most = quality_at(w);
    for (std::int32_t y = -kReach; y <= kReach; ++y) {
      for (std::int32_t x = -kReach; x <= kReach; ++x) {
        at_[w] = middle + Vec2i{x * step_, y * step_};
        if (const double now = quality_at(w); now > most) most = now, best = at_[w];
      }
    }
    at_[w] = best;
  }

  std::span<const Triangle> faces_;
  std::span<const Vec2> exact_;
  std::int32_t step_;
  std::vector<std::vector<std::size_t>> faces_at_;  // the faces at each wedge
  std::vector<Vec2i> at_;
};

}  // namespace

SnappedCoordinates snap_coordinates(std::span<const Triangle> faces, std::span<const Vec2> at) {
  const double most = mean_edge(faces, at) / kStepsPerEdge;
  std::int32_t step = 1;
  while (step * 2 <= most && step < kLargestStep)
    step *= 2;
  for (;; step /= 2) {
    Snapping snapping(faces, at, step);
    if (snapping.mend() || step == 1) return {snapping.take(), step};
  }
}

}  // namespace vitrine::inline codec
