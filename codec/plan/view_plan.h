// SPDX-License-Identifier: Apache-2.0
// Chooses the missing chunk that improves a camera's view the most. [Hoppe97] refines single
// vertices by the same measure, an error in pixels; this code chooses whole regions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codec/format/manifest.h"
#include "codec/plan/view.h"

namespace vitrine::inline codec {

class ViewPlan {
 public:
  // The arguments must outlive this object. `have` states for each chunk whether it is present. A
  // present chunk counts only if all coarser chunks of its region are present, too.
  ViewPlan(const Manifest& manifest, const std::vector<std::uint8_t>& have, const View& view);

  // Returns the chunk to fetch next. Returns nullopt if no visible error exceeds the view's limit,
  // or if every useful chunk has more than `bytes` bytes together with its missing prerequisites.
  //
  // Examines at most kMostSteps neighbours and chunks. This is enough for every model that the
  // encoder writes. If a hostile header needs more steps, returns the best chunk found so far, or
  // the first missing chunk of the file.
  std::optional<std::size_t> best(double bytes);

 private:
  // Maximum number of steps. Bounds the work if a hostile header describes long chains of
  // prerequisites.
  static constexpr std::uint64_t kMostSteps = 10'000'000;

  bool is_exhausted() const { return steps_ > kMostSteps; }
  std::optional<std::size_t> first_missing(double bytes) const;
  double gain(std::size_t chunk) const;
  std::vector<std::size_t> missing_for(std::size_t chunk);
  void require(std::size_t chunk, std::vector<std::size_t>& missing);

  const Manifest& manifest_;
  const std::vector<std::uint8_t>& have_;
  const View& view_;
  std::vector<std::uint32_t> leaf_level_;  // current level of each leaf of the region tree
  // Per chunk: number of the last missing_for() call that visited it.
  std::vector<std::uint32_t> required_;
  std::uint32_t call_ = 0;
  std::uint64_t steps_ = 0;  // total number of steps in missing_for() calls
};

}  // namespace vitrine::inline codec
