// SPDX-License-Identifier: Apache-2.0
// The states of a model. A state is a level of detail of the geometry and a set of pictures. Finds
// the cheapest state that is similar enough to the source, and measures few states for this.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace vitrine::bench {

struct ModelState {
  std::size_t geometry = 0;  // level of detail, from coarse to fine
  std::size_t pictures = 0;  // number of a set of pictures; the sets may be in any order

  auto operator<=>(const ModelState&) const = default;
};

// Bytes of each level of detail of the geometry, in ascending order, and of each set of pictures.
struct StateBytes {
  std::vector<double> geometry, pictures;

  double of(const ModelState& state) const {
    return geometry[state.geometry] + pictures[state.pictures];
  }
};

class StateGrid {
 public:
  // Returns the structural similarity of a state to the source.
  using Measure = std::function<double(const ModelState&)>;

  explicit StateGrid(Measure measure) : measure_(std::move(measure)) {}

  double ssim(const ModelState& state);

  // Returns the state with the fewest bytes whose similarity is at least `ssim`, or nullopt if
  // there is no such state. Assumes that finer geometry never looks worse with the same pictures.
  std::optional<ModelState> cheapest(double ssim, const StateBytes& bytes);

  // Returns the first state of a path whose similarity is at least `ssim`. Assumes that no state
  // looks worse than the one before.
  std::optional<ModelState> first(double ssim, const std::vector<ModelState>& path);

 private:
  Measure measure_;
  std::map<ModelState, double> known_;
};

}  // namespace vitrine::bench
