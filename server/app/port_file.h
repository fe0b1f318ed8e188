// SPDX-License-Identifier: Apache-2.0
// Tells others which port was bound.
#pragma once

#include <cstdint>
#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine {

// Writes the port and a newline; the file appears whole or not at all. An empty path does nothing.
Expected<void> write_port_file(const std::filesystem::path& file, std::uint16_t port);

}  // namespace vitrine
