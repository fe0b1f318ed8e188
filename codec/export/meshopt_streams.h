// SPDX-License-Identifier: Apache-2.0
// Compresses streams of a GLB file for EXT_meshopt_compression [glTF].
#pragma once

#include "codec/export/glb_streams.h"

namespace vitrine::inline codec {

// Orders faces and vertices so that they compress well. All faces must have the same material,
// because the new order would mix the faces of different materials.
void order_for_meshopt(SeamVertices& vertices);

// Both functions compress the bytes of a stream and set its `mode`. An attribute with the filter
// OCTAHEDRAL must have four floats per element; it decompresses to four bytes per element.
void compress_attribute(GlbStream& stream);
void compress_indices(GlbStream& stream, const SeamVertices& vertices);

}  // namespace vitrine::inline codec
