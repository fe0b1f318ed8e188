// SPDX-License-Identifier: Apache-2.0
// Finds the installation that a command line argument names.
#pragma once

#include <string>

#include "server/store/installation.h"
#include "server/store/quota.h"

namespace vitrine::server::cli {

// Returns the installation that the user names, either by its data folder or by its daemon's
// configuration file. The configuration file may name a bucket and a database. Environment
// variables override the file.
Expected<InstallationPlace> place_of(const std::string& text);

// The daemon's limits on disk space, and the uploads, which count towards them. They come from the
// configuration file, or from the data folder, where the daemon stores them.
struct StorageLimits {
  DiskLimits disk;
  std::filesystem::path uploads;
};
Expected<StorageLimits> storage_limits_of(const std::string& text);

// Checks that the disk of the data folder keeps `reserve` bytes free after `bytes` more were
// stored. Succeeds if objects are stored in a bucket. Fails with kLimit.
Expected<void> check_reserve(const InstallationPlace& place, std::uint64_t bytes,
                             std::uint64_t reserve);

// Succeeds if the installation exists or its folder is empty. A mistyped name therefore does not
// create a new installation. Fails with kIo.
Expected<void> check_existing(const InstallationPlace& place);

// Opens an installation for which check_existing() succeeds.
Expected<Installation> open_existing(const std::string& text);

}  // namespace vitrine::server::cli
