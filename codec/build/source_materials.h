// SPDX-License-Identifier: Apache-2.0
// Writes and reads the materials of a source mesh, and the names of its pictures (codec/FORMAT.md
// section 8.6).
#pragma once

#include "codec/core/byte_cursor.h"
#include "codec/core/expected.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Names longer than 1,000 bytes are cut off.
void write_source_materials(ByteWriter& out, const Texturing& texturing);

// Returns a texturing that has the materials and, for each picture, its name but no bytes. Fails
// (kBadInput) if a value is out of range, or if a map uses a picture or a set of coordinates that
// does not exist. Safe on hostile bytes.
Expected<Texturing> read_source_materials(ByteReader& in);

}  // namespace vitrine::inline codec
