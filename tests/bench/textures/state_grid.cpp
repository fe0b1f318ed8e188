// SPDX-License-Identifier: Apache-2.0
#include "state_grid.h"

#include <algorithm>
#include <limits>

#include "support/product_names.h"

namespace vitrine::bench {

double StateGrid::ssim(const ModelState& state) {
  const auto found = known_.find(state);
  if (found != known_.end()) return found->second;
  return known_[state] = measure_(state);
}

std::optional<ModelState> StateGrid::cheapest(double ssim, const StateBytes& bytes) {
  std::optional<ModelState> best;
  for (std::size_t pictures = 0; pictures < bytes.pictures.size(); ++pictures) {
    std::vector<ModelState> cheaper;
    for (std::size_t i = 0; i < bytes.geometry.size(); ++i) {
      const ModelState state{i, pictures};
      if (!best || bytes.of(state) < bytes.of(*best)) cheaper.push_back(state);
    }
    if (const auto found = first(ssim, cheaper)) best = found;
  }
  return best;
}

std::optional<ModelState> StateGrid::first(double ssim, const std::vector<ModelState>& path) {
  if (path.empty() || this->ssim(path.back()) < ssim) return {};
  const auto found = std::ranges::partition_point(
      path.begin(), path.end() - 1,
      [&](const ModelState& state) { return this->ssim(state) < ssim; });
  return *found;
}

}  // namespace vitrine::bench
