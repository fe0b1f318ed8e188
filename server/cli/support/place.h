// SPDX-License-Identifier: Apache-2.0
// Finds the installation that a command line argument names.
#pragma once

#include <string>

#include "server/store/disk_space.h"
#include "server/store/installation.h"

namespace vitrine::server::cli {

// Returns the installation that the user names, either by its data folder or by its daemon's
// configuration file. The configuration file may name a bucket and a database. Environment
// variables override the file.
Expected<InstallationPlace> place_of(const std::string& text);

// Returns the daemon's limits from the configuration file, or from the data folder, where the
// daemon stores them.
Expected<StorageLimits> storage_limits_of(const std::string& text);

// Succeeds if the installation exists or its folder is empty. A mistyped name therefore does not
// create a new installation. Fails with kIo.
Expected<void> check_existing(const InstallationPlace& place);

// Opens an installation for which check_existing() succeeds.
Expected<Installation> open_existing(const std::string& text);

}  // namespace vitrine::server::cli
