// SPDX-License-Identifier: Apache-2.0
// The vertex attributes and the indices of a mesh as a GLB file stores them [glTF].
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "codec/core/bounds.h"
#include "codec/export/export_options.h"
#include "codec/export/seam_vertices.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The numbers of component types in glTF.
enum class ComponentType : std::uint16_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

struct GlbStream {
  std::string_view semantic;  // such as "POSITION"; empty for indices
  ComponentType component = ComponentType::kFloat;
  std::uint32_t components = 3;  // number of components per element
  bool is_normalised = false;
  std::size_t count = 0, stride = 0;  // number of elements; bytes per element with padding
  // The bytes of the elements, in compressed form if `mode` is not empty.
  std::vector<std::uint8_t> bytes;
  std::string_view mode = {}, filter = {};  // values for EXT_meshopt_compression
  std::optional<Bounds> bounds = {};        // bounds of the stored elements; only for positions
};

// The mesh to be written, its normals, and the origin of the stored positions.
struct GlbSource {
  const TriangleMesh& mesh;
  std::span<const Vec3> normals;  // one per vertex of the mesh, or empty
  const SeamVertices& vertices;
  bool is_textured = false;
  Vec3 place = {};  // point of the scene at which stored positions are zero
};

// Returns positions, normals, and colours or texture coordinates, in single precision. Colours are
// in linear light. They have 8 bits per component if that suffices to restore every sRGB byte of
// the mesh, else 16 bits.
std::vector<GlbStream> exact_streams(const GlbSource& source);

// Returns the attributes of exact_streams() in forms that EXT_meshopt_compression compresses well.
// Positions are rounded to `grid`: to grid coordinates in 16 bits if `has_short_positions`, else to
// floats with as few significant bits as the grid needs. Without a grid, positions are exact.
// Normals have 8 bits per component. Texture coordinates from 0 to 1 have 16 bits.
//
// If `has_short_positions`, `source.place` must be a grid point that is at or below all positions
// on each axis, and the mesh must span at most 65,536 grid points along each axis.
std::vector<GlbStream> packed_streams(const GlbSource& source,
                                      const std::optional<ExportGrid>& grid,
                                      bool has_short_positions);

// Returns the indices. They have 16 bits if that suffices, else 32.
GlbStream index_stream(const SeamVertices& vertices);

}  // namespace vitrine::inline codec
