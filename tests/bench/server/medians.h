// SPDX-License-Identifier: Apache-2.0
// Reduces the figures of repeated runs to their medians.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "../codec/report.h"

namespace vitrine::bench {

inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// Collects the measured values of repeated runs. For each value, reports the run with the median
// ratio.
class Medians {
 public:
  void add(Figure figure) {
    const auto same = std::ranges::find_if(runs_, [&](const std::vector<Figure>& runs) {
      return runs[0].what == figure.what && runs[0].key == figure.key;
    });
    if (same == runs_.end()) {
      runs_.push_back({std::move(figure)});
    } else {
      same->push_back(std::move(figure));
    }
  }
  void report(Report& report) {
    for (std::vector<Figure>& runs : runs_) {
      std::ranges::sort(runs, {}, &Figure::ratio);
      report.add(runs[runs.size() / 2]);
    }
  }

 private:
  std::vector<std::vector<Figure>> runs_;
};

}  // namespace vitrine::bench
