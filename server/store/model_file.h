// SPDX-License-Identifier: Apache-2.0
// Rewrites the header of a .pmesh file without changing its chunks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server {

struct HeaderChange {
  // The finest level to keep; nullopt keeps all levels, pictures and optional blocks. If the number
  // of removed levels would be odd, this level is removed, too, unless it is the base mesh. If any
  // level is removed, so are the pictures outside the file's head, because they show more detail
  // than the remaining levels have. The optional blocks are removed in any case.
  std::optional<std::uint32_t> last_level;
  std::optional<std::string> unit;
};

// Returns the bytes of `pmesh` with the changed header, without the removed chunks and pictures.
// Fails with kBadInput if the header is damaged or a chunk is missing.
Expected<std::vector<std::uint8_t>> with_header(std::span<const std::uint8_t> pmesh,
                                                const HeaderChange& change);

}  // namespace vitrine::server
