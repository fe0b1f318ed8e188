// SPDX-License-Identifier: Apache-2.0
// A .pmesh whose header says something else of the same chunks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

struct HeaderChange {
  std::optional<std::uint32_t> last_level;  // finer ones are left out, and
                                            // this one, too, where their number is odd
  std::optional<std::string> unit;
};

// Fails with kBadInput where the header is damaged or a chunk is missing.
Expected<std::vector<std::uint8_t>> with_header(std::span<const std::uint8_t> pmesh,
                                                const HeaderChange& change);

}  // namespace vitrine
