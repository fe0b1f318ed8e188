// SPDX-License-Identifier: Apache-2.0
// Prints the benchmark's results as a table or as one JSON object.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace vitrine::bench {

inline constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

struct Figure {
  std::string what, key;
  double ours, peer, ratio, threshold;  // 0 if a value does not exist
  bool is_minimum = false;              // whether the threshold is a minimum instead of a maximum

  bool is_within() const { return is_minimum ? ratio >= threshold : ratio <= threshold; }
};

class Report {
 public:
  explicit Report(bool json);

  void add(const Figure& figure);
  // Prints the summary or the JSON object. Returns true if every ratio is within its threshold.
  bool finish();

 private:
  bool json_, within_ = true;
  std::size_t figures_ = 0, judged_ = 0;
  nlohmann::ordered_json json_out_;
};

}  // namespace vitrine::bench
