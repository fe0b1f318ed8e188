// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/store/installation.h"

namespace vitrine::cli {

// The installation that a person means: its data folder, or the configuration file of its daemon,
// which may name a bucket and a database; the environment goes before the file.
Expected<InstallationPlace> place_of(const std::string& text);

// The bytes that its models and uploads may take: what the file says, or the daemon has left in
// the folder. 0: no limit.
Expected<std::uint64_t> quota_of(const std::string& text);

// Whether it is there, or an empty folder: a mistyped name makes no installation. Fails with kIo.
Expected<void> check_existing(const InstallationPlace& place);

// Opens such a one.
Expected<Installation> open_existing(const std::string& text);

}  // namespace vitrine::cli
