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
  std::uint32_t components = 3;  // per element
  bool is_normalised = false;
  std::size_t count = 0, stride = 0;        // number of elements, and bytes from one to the next
  std::vector<std::uint8_t> bytes;          // the elements; compressed ones if `mode` is not empty
  std::string_view mode = {}, filter = {};  // of EXT_meshopt_compression
  std::optional<Bounds> bounds = {};        // of the stored elements; for positions
};

// The vertices of a file, and the positions to which the stored ones are relative.
struct GlbSource {
  const TriangleMesh& mesh;
  std::span<const Vec3> normals;  // one per vertex of the mesh, or empty
  const SeamVertices& vertices;
  bool is_textured = false;
  Vec3 place = {};  // the point of the scene at which stored positions are zero
};

// Returns positions, normals, and colours or texture coordinates, in single precision. Colours are
// in linear light. They have 8 bits if these restore every sRGB byte of the mesh, else 16 bits.
std::vector<GlbStream> exact_streams(const GlbSource& source);

// Returns the same attributes for EXT_meshopt_compression, which compresses them, and whether they
// need KHR_mesh_quantization. `grid` is the grid to which positions are rounded. If it has at most
// 65,536 points along each axis, positions are its coordinates in 16 bits: `source.place` must be a
// point of the grid, and no coordinate below it. Otherwise, they are floats with as few bits as the
// grid needs. Without a grid, they are exact. Normals have 8 bits per component. Texture
// coordinates from 0 to 1 have 16 bits.
std::vector<GlbStream> packed_streams(const GlbSource& source,
                                      const std::optional<ExportGrid>& grid,
                                      bool has_short_positions);

// Returns the indices, with 16 bits if these suffice.
GlbStream index_stream(const SeamVertices& vertices);

}  // namespace vitrine::inline codec
