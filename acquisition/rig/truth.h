// SPDX-License-Identifier: Apache-2.0
// Computes the ground truth for a scan: the part of the object's surface that can be scanned.
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
// sheet at two angles of the table. The vertex is seen if three conditions hold at one of these
// angles: (1) The vertex is inside the picture. (2) Laser source and camera both have a free line
// of sight to the vertex. (3) Both lines are on the same side of the surface, within kGrazing of
// the vertex's normal (the mean of its faces' normals). Both angles are computed exactly, so the
// flags do not depend on a scan's number of steps.
std::vector<std::uint8_t> seen_vertices(const TriangleMesh& mesh, const Solid& solid,
                                        const Optics& optics);

// Returns a binary PLY file in mm with the flags as `property uchar seen`.
std::vector<std::uint8_t> truth_ply(const TriangleMesh& mesh,
                                    const std::vector<std::uint8_t>& seen);

}  // namespace vitrine::acquisition::rig
