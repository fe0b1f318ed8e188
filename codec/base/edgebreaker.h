// SPDX-License-Identifier: Apache-2.0
// Reads the faces of the base mesh, which Draco codes by the edgebreaker method [Rossignac99] in
// reverse order [IS00]. Internal to codec/base.
#pragma once

#include <cstdint>

#include "codec/base/corner_table.h"
#include "codec/core/byte_cursor.h"
#include "codec/core/expected.h"

namespace vitrine::inline codec {

struct BaseCounts {
  std::uint32_t vertices = 0, faces = 0;
  std::uint32_t attributes = 0;  // number of attributes besides the position; at most 255
};

// Reads the connectivity section of a Draco buffer, and leaves `in` at the end of the section.
// Vertices are numbered like Draco's points. Fails (kBadInput) if the section is damaged or if its
// counts differ from `counts`. Fails (kUnsupported) if it has seams or uses a variant of the method
// that this codec's encoder never uses. Checks only that the indices in the table are in range;
// Connectivity::close checks that the faces form a valid mesh. Allocates at most 700 bytes per byte
// of `in`.
Expected<CornerTable> read_connectivity(ByteReader& in, const BaseCounts& counts);

}  // namespace vitrine::inline codec
