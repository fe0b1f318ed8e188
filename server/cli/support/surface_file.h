// SPDX-License-Identifier: Apache-2.0
// Reads the surface in a mesh file or a .pmesh file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codec/import/read_mesh.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"
#include "server/cli/support/input.h"

namespace vitrine::server::cli {

// kShape reads the mesh and its unit. kLooks also reads the texturing, which takes memory for its
// pictures.
enum class SurfaceParts : std::uint8_t { kShape, kLooks };

struct SurfaceInput {
  TriangleMesh mesh;
  std::string unit;  // empty if unknown
  // Empty for a .drc file, or if only kShape was requested. If the surface comes from another mesh
  // file, the factors and maps of the texturing are also multiplied into the vertex colours.
  Texturing texturing;
  // One line for each kind of material or picture in the file that `texturing` lacks.
  std::vector<std::string> not_carried;
};

// Reads a mesh file, or the finest level of a .pmesh file. `reading` applies to mesh files only.
// Must run in the sandbox if the bytes are untrusted.
Expected<SurfaceInput> read_surface(const InputFile& file, const std::string& name,
                                    const ReadOptions& reading = {},
                                    SurfaceParts parts = SurfaceParts::kShape);

// Converts the surface to `unit`. Has no effect unless both units are known.
void convert(SurfaceInput& surface, std::string_view unit);

}  // namespace vitrine::server::cli
