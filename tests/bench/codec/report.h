// SPDX-License-Identifier: Apache-2.0
// The table that the benchmark prints, or the JSON object in its place.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace vitrine::bench {

inline constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

struct Figure {
  std::string what, key;
  double ours, peer, ratio, threshold;  // ours and peer: 0 where there is none
  bool at_least = false;                // the threshold is the least, not the most

  bool is_within() const { return at_least ? ratio >= threshold : ratio <= threshold; }
};

class Report {
 public:
  explicit Report(bool json);

  void add(const Figure& figure);
  // Prints what is left to print; true if every ratio keeps its threshold.
  bool finish();

 private:
  bool json_, within_ = true;
  std::size_t figures_ = 0, judged_ = 0;
  nlohmann::ordered_json json_out_;
};

}  // namespace vitrine::bench
