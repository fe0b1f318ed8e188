// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/free_space.h"

#include <sys/statvfs.h>

#include <algorithm>

#include "server/jobs/place_of.h"

namespace vitrine::server {

std::uint64_t free_space(const std::filesystem::path& folder) {
  struct statvfs disk {};
  if (::statvfs(folder.c_str(), &disk) != 0) return UINT64_MAX;
  return std::uint64_t{disk.f_bavail} * disk.f_frsize;
}

std::uint64_t free_space(const Settings& settings) {
  return std::min(free_space(settings.data), free_space(uploads_of(settings)));
}

}  // namespace vitrine::server
