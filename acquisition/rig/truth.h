// SPDX-License-Identifier: Apache-2.0
// The ground truth for a scan: the object, and the part of its surface that can be scanned.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/rig_optics/optics.h"
#include "acquisition/rig_optics/solid.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition::rig {

// Largest angle, in degrees, between a surface's normal and a line of sight.
inline constexpr double kGrazing = 85;

// Returns one flag for each vertex: whether the scanner can see it. A vertex lies in the laser
// sheet at two angles of the table. It is seen if, at one of these angles, laser source and camera
// both have a free line of sight to it, on the same side of the surface and within kGrazing of the
// vertex's normal (the mean of its faces' normals), and it is inside the picture. The flags do not
// depend on a scan's number of steps, because both angles are computed exactly.
std::vector<std::uint8_t> seen_vertices(const TriangleMesh& mesh, const Solid& solid,
                                        const Optics& optics);

// Returns a binary PLY in mm that has the flag as `property uchar seen`.
std::vector<std::uint8_t> truth_ply(const TriangleMesh& mesh,
                                    const std::vector<std::uint8_t>& seen);

}  // namespace vitrine::acquisition::rig
