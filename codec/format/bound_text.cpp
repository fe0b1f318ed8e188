// SPDX-License-Identifier: Apache-2.0
#include "codec/format/bound_text.h"

#include <cstdio>
#include <cstdlib>

namespace vitrine::inline codec {
namespace {

std::string with_five_digits(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", number);
  return text;
}

}  // namespace

std::string bound_text(double bound) {
  constexpr double kHalfOfLastDigit = 5e-5;
  const std::string nearest = with_five_digits(bound);
  if (std::strtod(nearest.c_str(), nullptr) >= bound) return nearest;
  return with_five_digits(bound * (1 + kHalfOfLastDigit));
}

}  // namespace vitrine::inline codec
