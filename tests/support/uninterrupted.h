// SPDX-License-Identifier: Apache-2.0
// Repeats system calls that a signal interrupts. The end of a child process can interrupt calls on
// a socket that has a timeout, even if no handler is installed.
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
