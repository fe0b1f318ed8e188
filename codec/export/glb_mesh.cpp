// SPDX-License-Identifier: Apache-2.0
#include "codec/export/glb_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "codec/export/draco_primitive_writer.h"
#include "codec/export/far_from_origin.h"
#include "codec/export/meshopt_streams.h"
#include "codec/export/seam_vertices.h"

namespace vitrine::inline codec {
namespace {

SeamVertices unsplit(const TriangleMesh& mesh) {
  SeamVertices all{.faces = mesh.faces, .original = {}, .coordinates = {}};
  all.original.resize(mesh.positions.size());
  std::iota(all.original.begin(), all.original.end(), 0u);
  return all;
}

// Makes a GlbMesh step by step.
class MeshPreparation {
 public:
  explicit MeshPreparation(const GlbMeshSource& source) : source_(source) {}

  Expected<GlbMesh> run() {
    vertices_ = source_.texturing.empty() ? unsplit(source_.mesh)
                                          : split_at_seams(source_.mesh, source_.texturing);
    out_.primitives = {{.count = source_.mesh.faces.size()}};
    if (!source_.texturing.empty()) order_by_material();
    find_place();
    make_streams();
    if (is_draco()) {
      if (auto ok = compress_with_draco(); !ok) return tl::unexpected(ok.error());
    }
    return std::move(out_);
  }

 private:
  bool is_draco() const { return source_.compression == Compression::kDraco; }
  bool is_meshopt() const { return source_.compression == Compression::kMeshopt; }

  // Sorts the faces by material, and finds the faces of each material.
  void order_by_material() {
    std::vector<std::uint32_t> order(source_.mesh.faces.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto material_of = [&](std::uint32_t f) { return source_.texturing.face_materials[f]; };
    std::ranges::stable_sort(order, {}, material_of);
    std::vector<Triangle> faces;
    out_.primitives.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::uint16_t material = material_of(order[i]);
      if (i == 0 || out_.primitives.back().material != material)
        out_.primitives.push_back({.material = material, .first = i});
      ++out_.primitives.back().count;
      faces.push_back(vertices_.faces[order[i]]);
    }
    vertices_.faces = std::move(faces);
  }

  // Chooses the point to which stored positions are relative. For exact positions, this is the
  // origin, or the centre of the bounding box if the box is far from the origin. For positions
  // rounded without a grid, it is the lower corner of the box. With a grid, it is the grid point at
  // or below that corner. For meshopt, also sets the scale if all grid coordinates fit into 16
  // bits.
  void find_place() {
    const Bounds box = bounds_of(source_.mesh.positions);
    if (source_.compression == Compression::kNone || (is_meshopt() && !source_.grid)) {
      if (is_far_from_origin(box)) out_.place = box.centre();
      return;
    }
    out_.place = box.low;
    if (!source_.grid) return;
    const Vec3 origin = source_.grid->origin;
    const double step = source_.grid->step;
    const auto on_grid = [&](double low, double start) {
      return start + std::floor((low - start) / step) * step;
    };
    out_.place = {on_grid(box.low.x, origin.x), on_grid(box.low.y, origin.y),
                  on_grid(box.low.z, origin.z)};
    const Vec3 side = box.high - out_.place;
    const bool is_small = std::ceil(std::max({side.x, side.y, side.z}) / step) <= 65535;
    if (is_meshopt() && is_small) out_.scale = step;
  }

  void make_streams() {
    if (is_meshopt()) order_for_meshopt(vertices_);
    const GlbSource source{.mesh = source_.mesh,
                           .normals = source_.normals,
                           .vertices = vertices_,
                           .is_textured = !source_.texturing.empty(),
                           .place = out_.place};
    if (is_meshopt()) {
      out_.streams = packed_streams(source, source_.grid, out_.scale.has_value());
      out_.is_quantised = out_.scale || !source_.normals.empty();
      for (GlbStream& stream : out_.streams)
        compress_attribute(stream);
    } else {
      out_.streams = exact_streams(source);
    }
    out_.streams.push_back(index_stream(vertices_));
    if (is_meshopt()) compress_indices(out_.streams.back(), vertices_);
  }

  Expected<void> compress_with_draco() {
    const std::span attributes(out_.streams.data(), out_.attribute_count());
    auto compressed =
        compress_primitive(attributes, vertices_.faces, source_.grid ? source_.grid->step : 0);
    if (!compressed) return tl::unexpected(compressed.error());
    for (GlbStream& stream : out_.streams) {
      stream.count = compressed->points;
      stream.bytes.clear();
    }
    out_.streams.back().count = compressed->faces * 3;
    out_.primitives.front().count = compressed->faces;
    out_.draco = std::move(compressed->bytes);
    return {};
  }

  const GlbMeshSource& source_;
  SeamVertices vertices_;  // the vertices and faces of the file; the faces are sorted by material
  GlbMesh out_;
};

}  // namespace

Expected<GlbMesh> glb_mesh(const GlbMeshSource& source) {
  return MeshPreparation(source).run();
}

}  // namespace vitrine::inline codec
