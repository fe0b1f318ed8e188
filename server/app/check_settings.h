// SPDX-License-Identifier: Apache-2.0
// Checks that the files and addresses of a configuration can be used, without starting the daemon.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "codec/core/expected.h"
#include "server/config/settings.h"
#include "server/transport/live_tls.h"

namespace vitrine::server {

// Checks the files and folders that the settings name, and the configuration files `scanners`.
// Creates no file or folder, and accesses no device. Returns the opened certificate and key, or
// null if the settings do not enable TLS.
Expected<std::shared_ptr<LiveTls>> check_files(const Settings& settings,
                                               std::span<const std::filesystem::path> scanners);

// Checks that the daemon can listen on its addresses. Called before the data folder is created, so
// that a failed start leaves nothing behind.
Expected<void> check_addresses(const Settings& settings);

// Whether every user of the machine may read the folder.
bool others_may_read(const std::filesystem::path& folder);

// Returns `error` with the name of the setting admin-listen before its message.
Unexpected of_admin(const Error& error);

}  // namespace vitrine::server
