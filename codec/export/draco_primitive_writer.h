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
  // Number of points and faces after decompression; may differ from the input.
  std::size_t points = 0, faces = 0;
};

// Compresses the faces and their attributes. Attribute i gets the Draco ID i. Rounds positions to
// multiples of `step`, or to 24 bits per coordinate if that is coarser. Positions must not be
// negative. Fails (kUnsupported) with the error message of Draco.
Expected<CompressedPrimitive> compress_primitive(std::span<const GlbStream> attributes,
                                                 std::span<const Triangle> faces, double step);

}  // namespace vitrine::inline codec
