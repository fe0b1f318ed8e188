// SPDX-License-Identifier: Apache-2.0
// Writes the bound port to a file for other programs.
#pragma once

#include <cstdint>
#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine::server {

// Writes the port and a newline. Other programs never see an incomplete file. Writes no file if the
// path is empty.
Expected<void> write_port_file(const std::filesystem::path& file, std::uint16_t port);

}  // namespace vitrine::server
