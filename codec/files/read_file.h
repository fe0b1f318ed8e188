// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

// Everything in a file. Fails with kIo, and with kLimit where it is longer than `limit` bytes.
Expected<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path,
                                              std::uint64_t limit);

}  // namespace vitrine
