// SPDX-License-Identifier: Apache-2.0
// What a camera needs most of the chunks that are not held.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codec/progressive/manifest.h"
#include "codec/progressive/view.h"

namespace vitrine {

class ViewPlan {
 public:
  // All three outlive this. Of the chunks held, those count whose region has all coarser levels.
  ViewPlan(const Manifest& manifest, const std::vector<std::uint8_t>& have, const View& view);

  // The chunk to fetch next, of at most `bytes`; nothing where no error in sight is above the
  // view's, or what would help is longer. Looks at most at kMostSteps neighbours or chunks, far
  // more than an encoder's regions have; a header that makes for more gets the best of what it has
  // seen.
  std::optional<std::size_t> best(double bytes);

 private:
  // Where regions wait for many others that wait for many others.
  static constexpr std::uint64_t kMostSteps = 10'000'000;

  bool is_exhausted() const { return steps_ > kMostSteps; }
  std::optional<std::size_t> first_missing(double bytes) const;
  double gain(std::size_t chunk) const;
  std::vector<std::size_t> missing_for(std::size_t chunk);
  void require(std::size_t chunk, std::vector<std::size_t>& missing);

  const Manifest& manifest_;
  const std::vector<std::uint8_t>& have_;
  const View& view_;
  std::vector<std::uint32_t> leaf_level_;  // per leaf of the region tree
  std::vector<std::uint32_t> required_;    // per chunk: the newest call of missing_for() to meet it
  std::uint32_t call_ = 0;
  std::uint64_t steps_ = 0;  // of all calls of missing_for()
};

}  // namespace vitrine
