// SPDX-License-Identifier: Apache-2.0
// The properties of a chunk that the decoder takes from the header before it reads the chunk.
#pragma once

#include <cstdint>
#include <string>

#include "codec/core/expected.h"
#include "codec/core/fill_in.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

// Maximum number of vertices of an inserted component.
inline constexpr std::uint32_t kMostInserted = 64;

struct ChunkFrame {
  std::uint32_t level = 1;
  std::uint16_t region = 0;
  std::uint32_t splits = 0, inserted = 0;  // numbers of splits and of inserted vertices
  // Lattice shifts (cell.h) of this chunk's level and of the previous level.
  std::uint32_t shift = 0, shift_before = 0;
  Placement placement = Placement::kMidpoint;
  std::int32_t parity = 0;  // 0 or 1; see level_parity()
};

inline Unexpected damaged_chunk(const ChunkFrame& frame, std::string_view what) {
  return fail(ErrorCode::kBadInput,
              join({fill_in("damaged chunk (level {}, region {}): ", {frame.level, frame.region}),
                    what, "; fetch the file again"}));
}

}  // namespace vitrine::inline codec
