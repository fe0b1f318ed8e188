// SPDX-License-Identifier: Apache-2.0
// Proves that a `.pmesh` is intact and, if the original is given, that it is lossless.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "codec/core/progress.h"
#include "codec/import/read_mesh.h"

namespace vitrine::inline codec {

// The mesh file from which a model was built, and the options with which the file was read.
struct OriginalFile {
  std::span<const std::uint8_t> bytes;
  ReadOptions reading = {};
};

struct Verification {
  std::uint32_t levels = 0;
  std::uint64_t chunks = 0, vertices = 0, faces = 0;
  std::uint64_t pictures = 0;       // number of pictures in the texture
  bool has_originals = false;       // whether the originals of the texture are in the file
  std::uint32_t orders = 0;         // refinement orders checked, including the order by level
  std::optional<bool> is_lossless;  // nullopt if no original was given
};

// Checks the following:
// - The size of the file and every SHA-256 are right.
// - Each level is a manifold with boundary, and its counts match the header.
// - In each level, the box of a region contains all faces at the region's vertices.
// - The error stated for a level is at most the largest error stated for its chunks.
// - Full resolution has as many boundary loops as the header states.
// - Refinement in random orders reaches the same mesh and the same texture coordinates, and every
//   state on the way is a manifold.
// - Every picture of the texture is a WebP file of the side that the header states. In each level,
//   every corner has texture coordinates, and they are inside the picture.
// - The originals of the texture can be decoded.
// - If `input` is given: the finest level has the same faces as the repaired input rounded to the
//   lattice. The originals, if the file has any, equal the input's materials, texture coordinates
//   and pictures.
//
// Fails (kBadInput) at the first fault. A difference from `input` is not a fault; it sets
// `is_lossless` to false. libwebp decodes the pictures and is not safe on hostile bytes: call this
// in a sandbox for untrusted files.
Expected<Verification> verify_model(std::span<const std::uint8_t> pmesh,
                                    const std::optional<OriginalFile>& input,
                                    const ProgressReport& progress);

}  // namespace vitrine::inline codec
