// SPDX-License-Identifier: Apache-2.0
#include "training/fit.h"

#include <algorithm>
#include <cmath>

#include "codec/core/range_coder.h"

namespace vitrine::training {
namespace {

// -ln of the probability of a chunk's decisions under a beta prior.
double cost(const Counts& c, double zeros, double ones) {
  return std::lgamma(zeros) + std::lgamma(ones) - std::lgamma(zeros + ones) -
         std::lgamma(zeros + c.zeros) - std::lgamma(ones + c.ones) +
         std::lgamma(zeros + ones + c.zeros + c.ones);
}

double total_cost(const std::vector<Counts>& chunks, double one, double weight) {
  double sum = 0;
  for (const Counts& c : chunks)
    sum += cost(c, (1 - one) * weight, one * weight);
  return sum;
}

}  // namespace

std::uint16_t fit_start(const std::vector<Counts>& chunks) {
  double best = 1e300;
  std::uint16_t packed = 32768;
  if (chunks.empty()) return packed;
  for (std::uint16_t count = 1; count < 14; ++count) {
    const double weight = AdaptiveBit::kSeen[count] + 0.5;
    for (int step = 1; step < 128; ++step) {
      const double logit = (step - 64) / 8.0;
      const double one = 1 / (1 + std::exp(-logit));
      const double price = total_cost(chunks, one, weight);
      if (price >= best) continue;
      best = price;
      const auto probability = static_cast<std::uint16_t>(std::clamp(one * 4096, 1.0, 4095.0));
      packed = static_cast<std::uint16_t>(probability << 4 | count);
    }
  }
  return packed;
}

}  // namespace vitrine::training
