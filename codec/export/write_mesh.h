// SPDX-License-Identifier: Apache-2.0
// Writes a mesh as a file of one of the common formats, in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

// Positions keep single precision (OBJ and VRML: nine digits; DRC: 24 bits of the bounding box).
enum class MeshFormat {
  kPly,   // binary little-endian, uchar colours
  kGlb,   // glTF 2.0, colours as linear light (as glTF asks) in normalised 16-bit numbers
  kObj,   // colours as three numbers after the position
  kStl,   // binary; has no colours and no shared vertices
  kDrc,   // Draco edgebreaker, colours exact; Draco reorders vertices and faces
  kVrml,  // VRML 97, one IndexedFaceSet
};

// The format of "ply", "glb", "obj", "stl", "drc", "wrl", in either case, with or without a dot.
std::optional<MeshFormat> format_of_extension(std::string_view extension);

// `unit` is that of the positions, empty where it is unknown. PLY, OBJ and STL state it in a
// comment; GLB and VRML, which are in metres by their standards, are scaled to metres where it is
// one of kLengthUnits. Far from the origin PLY, OBJ, GLB and VRML hold double precision; STL and
// DRC cannot. Fails (kBadInput) on a mesh without faces and where a position does not fit a float,
// (kLimit) where a format's 32-bit sizes do not suffice.
Expected<std::vector<std::uint8_t>> write_mesh(const TriangleMesh& mesh, MeshFormat format,
                                               std::string_view unit = {});

// What people have to know of a mesh far from the origin in STL or DRC: by how much single
// precision moves its vertices, as "CAUSE; NEXT STEP". Else empty.
std::string note_on_precision(const TriangleMesh& mesh, MeshFormat format);

}  // namespace vitrine
