// SPDX-License-Identifier: Apache-2.0
// What is known of a chunk before its bytes are looked at.
#pragma once

#include <cstdint>
#include <string>

#include "codec/core/expected.h"
#include "codec/core/fill_in.h"
#include "codec/progressive/manifest.h"

namespace vitrine {

struct ChunkFrame {
  std::uint32_t level = 1;
  std::uint16_t region = 0;
  std::uint32_t splits = 0, newborn = 0;      // stated by the header
  std::uint32_t shift = 0, shift_before = 0;  // of this level's lattice and of the one before
  Placement placement = Placement::kMidpoint;
  std::int32_t parity = 0;  // level_parity()
};

inline Unexpected damaged_chunk(const ChunkFrame& frame, std::string_view what) {
  return fail(ErrorCode::kBadInput,
              join({fill_in("damaged chunk (level {}, region {}): ", {frame.level, frame.region}),
                    what, "; fetch the file again"}));
}

}  // namespace vitrine
