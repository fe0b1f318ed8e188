// SPDX-License-Identifier: Apache-2.0
// Prepares a mesh for a GLB file: splits vertices at seams, sorts faces by material, and makes the
// streams of attributes and indices, compressed if asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/export_options.h"
#include "codec/export/glb_streams.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The faces that use a material: `count` consecutive faces of the file, from index `first` on.
struct GlbPrimitive {
  std::uint16_t material = 0;
  std::size_t first = 0, count = 0;
};

struct GlbMesh {
  Vec3 place;                   // the point of the scene to which stored positions are relative
  std::optional<double> scale;  // scale of the node, if positions are stored as grid coordinates
  bool is_quantised = false;    // whether the streams need KHR_mesh_quantization
  std::vector<GlbPrimitive> primitives;
  // The streams of the attributes, then the stream of the indices. If Draco compresses the
  // primitive, the streams have no bytes.
  std::vector<GlbStream> streams;
  std::vector<std::uint8_t> draco;  // the primitive in Draco's compressed form; else empty

  std::size_t attribute_count() const { return streams.size() - 1; }
};

struct GlbMeshSource {
  const TriangleMesh& mesh;
  // Either empty, or has texture coordinates and a material for each face. The pictures are
  // ignored.
  const Texturing& texturing;
  std::span<const Vec3> normals;  // one unit vector per vertex of the mesh, or empty
  Compression compression = Compression::kNone;
  std::optional<ExportGrid> grid = {};  // the grid to which compression rounds positions
};

// Returns the mesh in the form in which the file stores it. Fails (kUnsupported) if Draco cannot
// compress it.
Expected<GlbMesh> glb_mesh(const GlbMeshSource& source);

}  // namespace vitrine::inline codec
