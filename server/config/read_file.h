// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine {

// The text of a configuration file. Fails with kIo.
Expected<std::string> read_config_file(const std::string& path);

// The settings that the daemon takes from that file and `environment`, as "NAME=value".
Expected<Settings> read_settings(const std::string& path,
                                 std::span<const std::string_view> environment);

}  // namespace vitrine
