// SPDX-License-Identifier: Apache-2.0
// Reads a configuration file.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine::server {

// Returns the text of the file. Fails with kIo if the file cannot be read.
Expected<std::string> read_config_file(const std::string& path);

// Returns the settings that a daemon would use with this file and environment. An entry of
// `environment` is "NAME=value".
Expected<Settings> read_settings(const std::string& path,
                                 std::span<const std::string_view> environment);

}  // namespace vitrine::server
