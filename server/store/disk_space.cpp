// SPDX-License-Identifier: Apache-2.0
#include "server/store/disk_space.h"

#include <fmt/core.h>
#include <sys/statvfs.h>

#include <algorithm>

namespace vitrine::server {
namespace {

// Returns how many bytes the store would grow if `files` were stored. A damaged file of the right
// length adds nothing, because an intact copy replaces it.
Expected<std::uint64_t> missing_bytes(const ObjectStore& store, std::span<const NamedFile> files) {
  std::uint64_t missing = 0;
  for (const NamedFile& file : files) {
    const auto held = store.size_of(file.file);
    if (!held) return tl::unexpected(held.error());
    missing += file.bytes - std::min(file.bytes, held->value_or(0));
  }
  return missing;
}

}  // namespace

std::uint64_t free_space(const std::filesystem::path& folder) {
  struct statvfs disk {};
  if (::statvfs(folder.c_str(), &disk) != 0) return UINT64_MAX;
  return std::uint64_t{disk.f_bavail} * disk.f_frsize;
}

Expected<void> check_free(const std::filesystem::path& folder, std::uint64_t bytes) {
  const std::uint64_t free = free_space(folder);
  if (bytes <= free) return {};
  return fail(ErrorCode::kLimit,
              fmt::format("{} bytes do not fit: the disk of {} has {} bytes free; free {} more "
                          "bytes, or choose another disk",
                          bytes, folder.string(), free, bytes - free));
}

Expected<void> check_reserve(const InstallationPlace& place, std::uint64_t bytes,
                             std::uint64_t reserve) {
  const std::uint64_t free = free_space(place.folder), room = free - std::min(free, reserve);
  if (!place.store.empty() || bytes <= room) return {};
  return fail(ErrorCode::kLimit,
              fmt::format("{} bytes do not fit: the disk of {} has {} bytes free, and the setting "
                          "disk-reserve keeps {} free; remove models or other files to free {} "
                          "more bytes, or lower disk-reserve",
                          bytes, place.folder.string(), free, reserve, bytes - room));
}

Expected<void> check_reserve(const Installation& installation, std::span<const NamedFile> files,
                             std::uint64_t reserve) {
  if (!installation.place.store.empty()) return {};
  const auto missing = missing_bytes(*installation.store, files);
  if (!missing) return tl::unexpected(missing.error());
  return *missing == 0 ? Expected<void>() : check_reserve(installation.place, *missing, reserve);
}

Expected<void> check_limits(const Installation& installation, std::span<const NamedFile> files,
                            const StorageLimits& limits) {
  const Uploads uploads(limits.uploads, {});
  Quota quota(*installation.catalogue, uploads, limits.disk.quota);
  if (const auto fits = quota.reserve(files, std::nullopt); !fits)
    return tl::unexpected(fits.error());
  return check_reserve(installation, files, limits.disk.reserve);
}

}  // namespace vitrine::server
