// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>

namespace vitrine::test {

// As many sockets as the system lets this process have, and what it starts from now on.
inline void raise_descriptor_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace vitrine::test
