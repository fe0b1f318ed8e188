// SPDX-License-Identifier: Apache-2.0
// What a scan is measured against: the object, and which of it can be scanned at all.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/rig/optics.h"
#include "acquisition/rig/solid.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::rig {

inline constexpr double kGrazing = 85;  // degrees off a surface's normal

// A flag a vertex. Seen is a vertex that, at one of the two angles of the table at which it lies in
// the laser sheet, neither the object hides from the laser's source or from the camera nor the edge
// of the picture cuts off, and whose surface both meet on the same side within kGrazing of its
// normal (the mean of its faces). Not a sample over steps: it is what ever finer steps come to.
std::vector<std::uint8_t> seen_vertices(const TriangleMesh& mesh, const Solid& solid,
                                        const Optics& optics);

// Binary PLY in mm, with the flag as `property uchar seen`.
std::vector<std::uint8_t> truth_ply(const TriangleMesh& mesh,
                                    const std::vector<std::uint8_t>& seen);

}  // namespace vitrine::rig
