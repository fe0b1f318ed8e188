// SPDX-License-Identifier: Apache-2.0
// Checks that the paths of a configuration can be used, without starting the daemon.
#pragma once

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine::server {

// Checks the data folder and the files that the daemon will write. If the data folder does not
// exist, checks the folder in which it would be created. Creates no file or folder. The error (kIo)
// names the key and the path.
Expected<void> check_paths(const Settings& settings);

// Whether every user of the machine may read the folder.
bool others_may_read(const std::filesystem::path& folder);

}  // namespace vitrine::server
