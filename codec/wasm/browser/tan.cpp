// SPDX-License-Identifier: Apache-2.0
// A tangent function that replaces that of wasi-libc, whose code for huge angles is larger than the
// whole planner. The argument is half a field of view, so it is less than a right angle. For such
// arguments, Lambert's continued fraction, x / (1 - x^2 / (3 - x^2 / (5 - ...))), has full
// precision after thirteen terms.
#include <cmath>

extern "C" double tan(double x) {
  double tail = 27;
  for (int term = 25; term > 0; term -= 2)
    tail = term - x * x / tail;
  return x / tail;
}
