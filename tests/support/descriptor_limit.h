// SPDX-License-Identifier: Apache-2.0
// Raises the limit of open files, for tests with many connections.
#pragma once

#include <sys/resource.h>

namespace vitrine::test {

// Raises the limit of open files for this process and its children, as far as the system permits.
inline void raise_descriptor_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace vitrine::test
