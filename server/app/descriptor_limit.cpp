// SPDX-License-Identifier: Apache-2.0
#include "server/app/host_system.h"

#include <sys/resource.h>

#include <algorithm>

namespace vitrine::server {

std::uint32_t connections_within_limit(std::uint32_t wanted) {
  // Number of descriptors reserved for 256 models, 64 admin connections and other files.
  constexpr rlim_t kOthers = 512;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
  const rlim_t needed = wanted + kOthers;
  if (limit.rlim_cur < needed) {
    const rlim_t before = limit.rlim_cur;
    limit.rlim_cur = std::min(needed, limit.rlim_max);
    if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) limit.rlim_cur = before;
  }
  const rlim_t others = std::min(kOthers, limit.rlim_cur / 2);
  const rlim_t fitting = std::max<rlim_t>(limit.rlim_cur - others, 1);
  return static_cast<std::uint32_t>(std::min<rlim_t>(wanted, fitting));
}

}  // namespace vitrine::server
