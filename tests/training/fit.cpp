// SPDX-License-Identifier: Apache-2.0
#include "training/fit.h"

#include <cmath>

#include "codec/coding/trained_tables.h"

namespace vitrine::training {
namespace {

// Returns the cost of a chunk's decisions: minus the natural logarithm of their probability, under
// a beta prior with the parameters `zeros` and `ones`.
double cost(const BitCounts& c, double zeros, double ones) {
  return std::lgamma(zeros) + std::lgamma(ones) - std::lgamma(zeros + ones) -
         std::lgamma(zeros + c.zeros) - std::lgamma(ones + c.ones) +
         std::lgamma(zeros + ones + c.zeros + c.ones);
}

double total_cost(const std::vector<BitCounts>& chunks, double one, double weight) {
  double sum = 0;
  for (const BitCounts& c : chunks)
    sum += cost(c, (1 - one) * weight, one * weight);
  return sum;
}

}  // namespace

Start fit_start(const std::vector<BitCounts>& chunks) {
  double best = 1e300;
  constexpr int kHalf = trained::kHalf;
  Start start{kHalf, 0};
  if (chunks.empty()) return start;
  for (int seen = 1; seen < static_cast<int>(trained::kSeen.size()); ++seen) {
    const double weight = trained::kSeen[static_cast<std::size_t>(seen)] + 0.5;
    for (int step = 1; step < 2 * kHalf; ++step) {
      const double logit = (step - kHalf) / 8.0;
      const double price = total_cost(chunks, 1 / (1 + std::exp(-logit)), weight);
      if (price >= best) continue;
      best = price;
      start = {step, seen};
    }
  }
  return start;
}

}  // namespace vitrine::training
