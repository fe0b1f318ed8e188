// SPDX-License-Identifier: Apache-2.0
// The tangent in place of wasi-libc's own, whose reduction of huge angles weighs more than the
// whole planner. Half of a field of view is below a right angle: Lambert's continued fraction,
// x / (1 - x^2 / (3 - x^2 / (5 - ...))), has all digits there after thirteen terms.
#include <cmath>

extern "C" double tan(double x) {
  double tail = 27;
  for (int term = 25; term > 0; term -= 2)
    tail = term - x * x / tail;
  return x / tail;
}
