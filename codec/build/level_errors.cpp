// SPDX-License-Identifier: Apache-2.0
#include "codec/build/level_errors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/build/display_fit.h"
#include "codec/refine/display_filter.h"

namespace vitrine::inline codec {
namespace {

// Raises the chunk's error bound for faces between the chunk's region and a neighbour region that
// is one level finer. The corners of these faces that lie in the chunk's region still lack the low
// bits of their positions. These bits arrive with the region's next chunk.
void allow_for_finer_neighbours(ChunkInfo& chunk, const Manifest& manifest) {
  const std::uint32_t finer = chunk.level + 1;
  if (finer >= manifest.levels.size() || manifest.tree.regions_at(finer).size() == 1) return;
  const std::int32_t cells =
      (1 << manifest.levels[chunk.level].shift) - (1 << manifest.levels[finer].shift);
  const RegionNode& region = manifest.region(chunk);
  for (std::uint32_t leaf = region.first; leaf < region.first + region.leaves; ++leaf) {
    const ChunkInfo& next = manifest.chunks[manifest.find_chunk(finer, leaf)];
    chunk.max_error = std::max(chunk.max_error, next.max_error);
  }
  chunk.max_error += std::sqrt(0.75) * cells * manifest.lattice.step;
}

std::vector<std::uint16_t> leaves_of(const MeshState& level) {
  std::vector<std::uint16_t> leaves;
  leaves.reserve(level.vertex_count());
  for (VertexId v = 0; v < level.vertex_count(); ++v)
    leaves.push_back(level.vertex[v].region);
  return leaves;
}

}  // namespace

LevelErrors::LevelErrors(TriangleMesh original, const Hierarchy& hierarchy, unsigned threads)
    : meter_(std::move(original)),
      lattice_(hierarchy.base.lattice),
      tree_(hierarchy.tree),
      leaf_(hierarchy.leaf),
      queue_(threads, meter_.original().size() / 2 * 3) {}

void LevelErrors::add(const MeshState& level, bool is_last) {
  const std::size_t weight = weight_of(is_last ? 0 : level.connectivity.face_count());
  queue_.make_room(weight);
  double filter = is_last ? 0 : fit_display_filter(level, lattice_, meter_.original());
  filter = static_cast<float>(filter);  // rounds to float, as stored in the header
  filters_.push_back(filter);
  LevelError& error = errors_.emplace_back();
  if (is_last) {
    queue_.add({[this, &error, regions = regions_of({})] {
                  error = meter_.measure_moved(
                      [this](const Vec3& p) { return lattice_.to_model(lattice_.to_lattice(p)); },
                      regions);
                },
                weight});
  } else {
    queue_.add({[this, &error, mesh = displayed(level, filter),
                 regions = regions_of(leaves_of(level))]() mutable {
                  error = meter_.measure(std::move(mesh), regions);
                },
                weight});
  }
}

void LevelErrors::finish(Manifest& manifest) {
  queue_.finish();
  for (std::size_t i = 0; i < manifest.levels.size(); ++i) {
    manifest.levels[i].display_filter = filters_[i];
    manifest.levels[i].max_error = errors_[i].max_error;
    manifest.levels[i].rms_error = errors_[i].rms_error;
  }
  std::vector<std::size_t> entered(errors_.size());
  for (ChunkInfo& chunk : manifest.chunks)
    chunk.max_error = errors_[chunk.level].region_errors[entered[chunk.level]++];
  for (ChunkInfo& chunk : manifest.chunks)
    allow_for_finer_neighbours(chunk, manifest);
}

// Returns an estimate of the memory for measuring a level with `faces` faces, in units of the
// memory for one face. The second term is the memory that every level needs, whatever its size.
std::size_t LevelErrors::weight_of(std::size_t faces) const {
  return faces + meter_.original().size() / 8;
}

TriangleMesh LevelErrors::displayed(const MeshState& level, double filter) const {
  TriangleMesh mesh;
  const LevelInfo shown{.display_filter = filter, .shift = level.shift};
  mesh.positions.reserve(level.vertex_count());
  for (VertexId v = 0; v < level.vertex_count(); ++v)
    mesh.positions.push_back(lattice_.origin + display_position(level, v, shown) * lattice_.step);
  mesh.faces = level.real_faces();
  return mesh;
}

// Returns, for each leaf of the region tree, the index of the current level's region that contains
// the leaf. Adds the number of these regions to `count`.
std::vector<std::uint16_t> LevelErrors::number_regions(std::uint32_t& count) const {
  std::vector<std::uint16_t> of_leaf(tree_.leaves());
  for (const std::uint32_t node :
       tree_.regions_at(static_cast<std::uint32_t>(filters_.size() - 1))) {
    const RegionNode& region = tree_.nodes[node];
    std::fill_n(of_leaf.begin() + region.first, region.leaves, static_cast<std::uint16_t>(count++));
  }
  return of_leaf;
}

// Returns the regions of the level's vertices and of the original's vertices. Both lists are empty
// if the level has only one region. `leaves` holds the region tree leaf of each vertex of the
// level.
LevelRegions LevelErrors::regions_of(std::vector<std::uint16_t> leaves) const {
  LevelRegions out{.of_level = std::move(leaves), .of_original = leaf_, .count = 0};
  const auto of_leaf = number_regions(out.count);
  if (out.count == 1) return {};
  for (auto* regions : {&out.of_level, &out.of_original}) {
    for (std::uint16_t& region : *regions)
      region = of_leaf[region];
  }
  return out;
}

}  // namespace vitrine::inline codec
