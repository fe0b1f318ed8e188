// SPDX-License-Identifier: Apache-2.0
// System calls that are made again where a signal interrupts them. A child that ends does so to a
// socket's that has a time limit, even where nobody handles the signal.
#pragma once

#include <cerrno>

namespace vitrine::test {

template <class Call>
auto uninterrupted(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR)
    result = call();
  return result;
}

}  // namespace vitrine::test
