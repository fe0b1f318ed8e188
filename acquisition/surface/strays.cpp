// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/strays.h"

#include <algorithm>
#include <numeric>

namespace vitrine::acquisition {
namespace {

// Number of following steps to search. It is 2, because one picture may be missing.
constexpr std::size_t kStepsOn = 2;
// Number of following points to search within a strand. In other strands, the search covers this
// many points on either side.
constexpr std::size_t kReach = 2;
constexpr int kNeighbours = 3;

class Pieces {
 public:
  explicit Pieces(std::size_t count) : parent_(count), size_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    if (a == b) return;
    if (size_[a] < size_[b]) std::swap(a, b);
    parent_[b] = static_cast<std::uint32_t>(a), size_[a] += size_[b];
  }
  std::size_t size(std::size_t i) { return size_[root(i)]; }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::vector<std::uint32_t> parent_, size_;
};

// Visits each pair of neighbouring points once.
class Neighbours {
 public:
  Neighbours(const Cloud& cloud, double reach) : cloud_(cloud), reach_(reach) {}

  template <class Visit>
  void visit(Visit visit) const {
    const std::size_t steps = std::min(kStepsOn, (cloud_.step_count() - 1) / 2);
    for (std::size_t s = 0; s < cloud_.step_count(); ++s) {
      for (std::size_t k = cloud_.steps[s]; k < cloud_.steps[s + 1]; ++k) {
        within(k, visit);
        for (std::size_t step = 1; step <= steps; ++step) {
          const std::size_t other = cloud_.after(s, step);
          between(k, cloud_.steps[other], cloud_.steps[other + 1], visit);
        }
      }
    }
  }

 private:
  template <class Visit>
  void within(std::size_t strand, Visit visit) const {
    const std::size_t first = cloud_.first[strand], end = cloud_.first[strand + 1];
    for (std::size_t i = first; i < end; ++i) {
      for (std::size_t j = i + 1; j < std::min(i + 1 + kReach, end); ++j)
        look(i, j, visit);
    }
  }

  // Visits pairs of neighbours: a point of the strand `strand`, and a point of a strand from `from`
  // to `to` - 1.
  template <class Visit>
  void between(std::size_t strand, std::size_t from, std::size_t to, Visit visit) const {
    const auto& points = cloud_.strands[strand].points;
    for (std::size_t other = from; other < to; ++other) {
      const auto& others = cloud_.strands[other].points;
      std::size_t near = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        while (near < others.size() && others[near].row < points[i].row)
          ++near;
        const std::size_t end = std::min(near + kReach, others.size());
        for (std::size_t j = near - std::min(near, kReach); j < end; ++j)
          look(cloud_.first[strand] + i, cloud_.first[other] + j, visit);
      }
    }
  }

  template <class Visit>
  void look(std::size_t a, std::size_t b, Visit visit) const {
    const Vec3 d = cloud_.positions[a] - cloud_.positions[b];
    if (dot(d, d) <= reach_ * reach_) visit(a, b);
  }

  const Cloud& cloud_;
  double reach_;
};

}  // namespace

Strays find_strays(const Cloud& cloud, double reach, std::size_t smallest) {
  Strays strays{std::vector<bool>(cloud.size(), true)};
  std::vector<std::uint8_t> neighbours(cloud.size(), 0);
  const Neighbours pairs(cloud, reach);
  pairs.visit([&](std::size_t a, std::size_t b) { ++neighbours[a], ++neighbours[b]; });
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (neighbours[i] < kNeighbours) strays.kept[i] = false, ++strays.outliers;
  }
  Pieces pieces(cloud.size());
  pairs.visit([&](std::size_t a, std::size_t b) {
    if (strays.kept[a] && strays.kept[b]) pieces.join(a, b);
  });
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!strays.kept[i] || pieces.size(i) >= smallest) continue;
    strays.kept[i] = false, ++strays.isolated;
  }
  return strays;
}

}  // namespace vitrine::acquisition
