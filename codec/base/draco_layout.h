// SPDX-License-Identifier: Apache-2.0
// Constants of the Draco bitstream [Draco] that both the encoder and the reader of the base mesh
// use. Internal to codec/base.
#pragma once

#include <cstdint>

#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

inline constexpr std::uint8_t kDracoPosition = 0;  // Draco's attribute type for positions
inline constexpr std::uint8_t kDracoColour = 2;
inline constexpr std::uint8_t kDracoInt32 = 5;  // Draco's data type for 32-bit integers

// Returns the Draco attribute type that stores `semantic`.
constexpr std::uint8_t draco_type(Semantic semantic) {
  switch (semantic) {
    case Semantic::kColour:
      break;
  }
  return kDracoColour;
}

}  // namespace vitrine::inline codec
