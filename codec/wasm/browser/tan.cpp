// SPDX-License-Identifier: Apache-2.0
// A tangent function that replaces the one of wasi-libc, whose reduction of huge angles has more
// code than the whole planner. The argument is half a field of view, which is less than a right
// angle. In that range Lambert's continued fraction, x / (1 - x^2 / (3 - x^2 / (5 - ...))), has
// full precision after thirteen terms.
#include <cmath>

extern "C" double tan(double x) {
  double tail = 27;
  for (int term = 25; term > 0; term -= 2)
    tail = term - x * x / tail;
  return x / tail;
}
