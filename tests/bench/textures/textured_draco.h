// SPDX-License-Identifier: Apache-2.0
// Draco files of textured meshes: one for each material, as in a GLB.
#pragma once

#include "wedge_mesh.h"

namespace vitrine::bench {

// Returns for each material the file that `draco_encoder -qp BITS -qt 12 -cl 10` writes. A file is
// empty if no face has the material.
std::vector<Bytes> draco_with_coordinates(const MeshoptInput& mesh, std::size_t materials,
                                          int bits);

// Returns the files of draco_with_coordinates(), but without texture coordinates.
std::vector<Bytes> draco_without_coordinates(const MeshoptInput& mesh, std::size_t materials,
                                             int bits);

double total_bytes(const std::vector<Bytes>& files);

// Decodes the files of draco_with_coordinates().
FacedMesh decode_draco(const std::vector<Bytes>& files);

}  // namespace vitrine::bench
