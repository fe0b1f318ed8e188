// SPDX-License-Identifier: Apache-2.0
// Reads a whole file into memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Returns the contents of the file `path`. Fails with kIo, or with kLimit if the file is longer
// than `limit` bytes.
Expected<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path,
                                              std::uint64_t limit);

}  // namespace vitrine::inline codec
