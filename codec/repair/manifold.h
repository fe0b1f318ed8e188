// SPDX-License-Identifier: Apache-2.0
// The two steps that make an oriented manifold of triangles: orienting faces, splitting vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/repair/edge_groups.h"

namespace vitrine::inline codec {

// Gives all faces of each patch the orientation of the patch's majority. A patch consists of faces
// connected by edges with exactly two faces. Patches whose faces already agree do not change.
// `groups` holds the edges of `faces` and is not updated. Returns the reversed faces in ascending
// order. The second and third corners of these faces were swapped.
std::vector<std::uint32_t> orient_patches(std::span<Triangle> faces, const EdgeGroups& groups);

// Splits vertices that belong to several fans of faces.
//
// The first fan of each vertex keeps the vertex; every other fan gets a copy of it. Two faces at a
// vertex are in the same fan if one can be reached from the other through paired edges
// (edge_pairs.h) at that vertex. Rewrites `faces`. Returns the original vertex of each copy. Copies
// are numbered from `vertex_count` on. Uses OpenMesh's half-edge kernel, but only for faces around
// vertices with several fans.
std::vector<std::uint32_t> split_fans(std::uint32_t vertex_count, std::span<Triangle> faces,
                                      std::span<const std::uint32_t> across);

}  // namespace vitrine::inline codec
