// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/strays.h"

#include <algorithm>
#include <numeric>

namespace vitrine {
namespace {

constexpr std::size_t kProfiles = 2;  // further on, so that one picture may be missing
constexpr std::size_t kPoints = 2;    // further on within a profile; on either side in the others
constexpr int kFewest = 3;            // neighbours

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

// visit(a, b) for each pair of neighbours, once.
template <class Visit>
void for_neighbours(const Cloud& cloud, double reach, Visit visit) {
  const auto look = [&](std::size_t a, std::size_t b) {
    const Vec3 d = cloud.positions[a] - cloud.positions[b];
    if (dot(d, d) <= reach * reach) visit(a, b);
  };
  const std::size_t steps = std::min(kProfiles, (cloud.profiles.size() - 1) / 2);
  for (std::size_t k = 0; k < cloud.profiles.size(); ++k) {
    const auto& points = cloud.profiles[k].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = i + 1; j < std::min(i + 1 + kPoints, points.size()); ++j)
        look(cloud.first[k] + i, cloud.first[k] + j);
    }
    for (std::size_t step = 1; step <= steps; ++step) {
      const std::size_t other = cloud.after(k, step);
      const auto& others = cloud.profiles[other].points;
      std::size_t near = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        while (near < others.size() && others[near].row < points[i].row)
          ++near;
        const std::size_t to = std::min(near + kPoints, others.size());
        for (std::size_t j = near - std::min(near, kPoints); j < to; ++j)
          look(cloud.first[k] + i, cloud.first[other] + j);
      }
    }
  }
}

}  // namespace

Strays find_strays(const Cloud& cloud, double reach, std::size_t smallest) {
  Strays strays{std::vector<bool>(cloud.size(), true)};
  std::vector<std::uint8_t> neighbours(cloud.size(), 0);
  for_neighbours(cloud, reach,
                 [&](std::size_t a, std::size_t b) { ++neighbours[a], ++neighbours[b]; });
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (neighbours[i] < kFewest) strays.kept[i] = false, ++strays.outliers;
  }
  Pieces pieces(cloud.size());
  for_neighbours(cloud, reach, [&](std::size_t a, std::size_t b) {
    if (strays.kept[a] && strays.kept[b]) pieces.join(a, b);
  });
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!strays.kept[i] || pieces.size(i) >= smallest) continue;
    strays.kept[i] = false, ++strays.isolated;
  }
  return strays;
}

}  // namespace vitrine
