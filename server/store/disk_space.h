// SPDX-License-Identifier: Apache-2.0
// Checks before files are copied whether the disk and the limits of an installation have room for
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "server/store/installation.h"
#include "server/store/quota.h"

namespace vitrine::server {

// The daemon's limits on disk space, and the folder of the uploads, which count towards the limits.
struct StorageLimits {
  DiskLimits disk;
  std::filesystem::path uploads;
};

// Returns the number of free bytes on the disk of the folder, or UINT64_MAX if it is unknown.
std::uint64_t free_space(const std::filesystem::path& folder);

// Checks that the disk of `folder` has room for `bytes` more. Fails with kLimit.
Expected<void> check_free(const std::filesystem::path& folder, std::uint64_t bytes);

// Checks that the disk of the data folder still has `reserve` bytes free after `bytes` more are
// stored. Succeeds if objects are stored in a bucket. Fails with kLimit.
Expected<void> check_reserve(const InstallationPlace& place, std::uint64_t bytes,
                             std::uint64_t reserve);

// Checks that the disk still has `reserve` bytes free after `files` are stored. `files` must list
// each file once. Files that the installation already has need no room. Succeeds if objects are
// stored in a bucket. Fails with kLimit, and with kIo if the store fails.
Expected<void> check_reserve(const Installation& installation, std::span<const NamedFile> files,
                             std::uint64_t reserve);

// Checks that quota and disk have room for `files` of another installation. `files` must list each
// file once. Fails as check_reserve() does, and with kIo if the catalogue fails.
Expected<void> check_limits(const Installation& installation, std::span<const NamedFile> files,
                            const StorageLimits& limits);

}  // namespace vitrine::server
