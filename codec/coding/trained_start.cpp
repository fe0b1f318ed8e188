// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "codec/coding/trained_tables.h"

namespace vitrine::inline codec::trained {
namespace {

// Reads a number and the space after it. The result is correctly rounded: a double holds both the
// numerator and the denominator exactly, so only the division rounds. A test checks all numbers in
// the tables.
double read_number(const char*& text) {
  const bool negative = *text == '-';
  if (negative) ++text;
  double digits = 0, power = 1;
  for (bool fraction = false; *text >= '.'; ++text) {
    if (*text == '.') {
      fraction = true;
    } else if (*text == 'e') {  // an exponent is always 'e', '-' and two digits
      for (int places = (text[2] - '0') * 10 + text[3] - '0'; places > 0; --places)
        power *= 10;
      text += 3;
    } else {
      digits = digits * 10 + (*text - '0');
      if (fraction) power *= 10;
    }
  }
  ++text;
  return (negative ? -digits : digits) / power;
}

using Probabilities = std::array<std::uint16_t, 2 * kHalf>;

// Converts a probability to units of 1/65536, with a precision of 12 bits. The result is never 0 or
// 65536.
std::uint16_t twelve_bits(double probability) {
  return static_cast<std::uint16_t>(std::max(static_cast<int>(probability * 4096), 1) << 4 | 8);
}

Probabilities all_probabilities() {
  Probabilities all{};
  // ratio of the odds of successive table entries: exp(-1 / 8)
  constexpr double kStep = 0.8824969025845955;
  double odds = 1;
  for (std::size_t step = 0; step < kHalf; ++step, odds *= kStep) {
    all[kHalf + step] = twelve_bits(1 / (1 + odds));
    all[kHalf - step] = twelve_bits(odds / (1 + odds));
  }
  return all;
}

}  // namespace

void load(const char* text, std::span<double> numbers) {
  for (double& number : numbers)
    number = read_number(text);
}

void load(const std::uint8_t* packed, std::span<AdaptiveBit> bits) {
  static const Probabilities kProbabilities = all_probabilities();
  for (AdaptiveBit& bit : bits) {
    bit = {kProbabilities[packed[0]], kSeen[packed[1]]};
    packed += 2;
  }
}

}  // namespace vitrine::inline codec::trained
