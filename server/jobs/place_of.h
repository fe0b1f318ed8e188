// SPDX-License-Identifier: Apache-2.0
// Derives the locations of an installation, and its limits on disk space, from the settings.
#pragma once

#include <algorithm>

#include "server/config/settings.h"
#include "server/store/disk_space.h"
#include "server/store/installation.h"
#include "server/store/quota.h"

namespace vitrine::server {

inline InstallationPlace place_of(const Settings& settings) {
  return {.folder = settings.data,
          .store = settings.store,
          .catalogue = settings.catalogue,
          .access_key = settings.store_access_key,
          .secret_key = settings.store_secret_key};
}

inline std::filesystem::path uploads_of(const Settings& settings) {
  return settings.uploads.empty() ? settings.data / "uploads" : settings.uploads;
}

inline DiskLimits disk_limits_of(const Settings& settings) {
  return {.quota = settings.quota_bytes, .reserve = settings.disk_reserve_bytes};
}

// Returns how many more bytes may be written to the disk of the data folder, so that the bytes of
// the setting disk-reserve stay free.
inline std::uint64_t room_of(const Settings& settings) {
  const std::uint64_t free = free_space(settings.data);
  return free - std::min(free, settings.disk_reserve_bytes);
}

}  // namespace vitrine::server
