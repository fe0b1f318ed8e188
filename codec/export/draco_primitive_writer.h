// SPDX-License-Identifier: Apache-2.0
// Compresses a primitive of a GLB file for KHR_draco_mesh_compression [glTF].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/glb_streams.h"

namespace vitrine::inline codec {

struct CompressedPrimitive {
  std::vector<std::uint8_t> bytes;
  std::size_t points = 0, faces = 0;  // after decompression
};

// Compresses the faces and their attributes; attribute i has the number i in the result. Positions
// are rounded to multiples of `step`, or to 24 bits if that is coarser; they must not be negative.
// Fails (kUnsupported) with the error message of Draco.
Expected<CompressedPrimitive> compress_primitive(std::span<const GlbStream> attributes,
                                                 std::span<const Triangle> faces, double step);

}  // namespace vitrine::inline codec
