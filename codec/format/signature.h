// SPDX-License-Identifier: Apache-2.0
// Recognises a `.pmesh` by its first bytes.
#pragma once

#include <cstdint>
#include <span>

namespace vitrine::inline codec {

// Whether `bytes` starts with the signature of a `.pmesh` of any version.
bool is_pmesh(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
