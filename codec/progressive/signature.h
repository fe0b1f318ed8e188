// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace vitrine {

// Whether the first bytes are the signature of a .pmesh of any version.
bool is_pmesh(std::span<const std::uint8_t> bytes);

}  // namespace vitrine
