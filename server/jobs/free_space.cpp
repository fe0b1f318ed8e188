// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/free_space.h"

#include <algorithm>

#include "server/jobs/place_of.h"
#include "server/store/disk_space.h"

namespace vitrine::server {

std::uint64_t free_space(const Settings& settings) {
  return std::min(free_space(settings.data), free_space(uploads_of(settings)));
}

}  // namespace vitrine::server
