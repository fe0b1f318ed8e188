// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/refiner.h"

#include <algorithm>

#include "codec/core/fill_in.h"
#include "codec/progressive/colour.h"
#include "codec/progressive/display_filter.h"
#include "codec/progressive/layer_decoder.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

struct Refiner::State {
  std::shared_ptr<const Manifest> manifest;
  MeshState mesh;
  std::vector<std::uint8_t> applied;
  std::vector<std::uint8_t> leaf_level;  // per leaf of the region tree: the level it has reached
  LayerChange newest;                    // by the chunk applied last
  std::uint32_t faces = 0;               // real ones
  bool usable = true;

  ChunkFrame frame(const ChunkInfo& chunk) const;
  // Of the two that a split of `newest` brought.
  std::uint32_t real_faces_of(std::size_t split) const {
    const std::uint32_t face = newest.splits.face(split);
    return (mesh.connectivity.is_real(face) ? 1 : 0) +
           (mesh.connectivity.is_real(face + 1) ? 1 : 0);
  }
  bool undo_one();  // false where nothing is left of `newest`
};

ChunkFrame Refiner::State::frame(const ChunkInfo& chunk) const {
  const auto last = static_cast<std::uint32_t>(manifest->levels.size() - 1);
  return {.level = chunk.level,
          .region = static_cast<std::uint16_t>(chunk.region),
          .splits = chunk.splits,
          .newborn = chunk.newborn,
          .shift = manifest->levels[chunk.level].shift,
          .shift_before = manifest->levels[chunk.level - 1].shift,
          .placement = manifest->placement,
          .parity = level_parity(chunk.level, last)};
}

bool Refiner::State::undo_one() {
  if (!newest.components.empty()) {
    faces -= newest.components.back().real_faces;
    mesh.remove(newest.components.back());
    newest.components.pop_back();
    return true;
  }
  if (newest.splits.size() == 0) return false;
  const std::size_t last = newest.splits.size() - 1;
  const Split split = newest.splits.splits[last];
  faces -= real_faces_of(last);
  mesh.connectivity.unsplit(split.v);
  mesh.disinherit();
  mesh.positions[split.v] = split.merged;
  if (!mesh.colours.empty()) mesh.colours[split.v] = newest.splits.merged_colours[last];
  newest.splits.splits.pop_back();
  return true;
}

Refiner::Refiner(std::unique_ptr<State> state) : state_(std::move(state)) {}
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;
Refiner::~Refiner() = default;

Expected<Refiner> Refiner::start(std::shared_ptr<const Manifest> manifest, const BaseMesh& base) {
  const LevelInfo& level = manifest->levels[0];
  const std::size_t colours = manifest->coloured ? base.positions.size() : 0;
  if (base.positions.size() != level.vertices || base.faces.size() != level.faces ||
      base.colours.size() != colours) {
    return damaged_base("its counts are not those of the header");
  }
  auto mesh = MeshState::from_base(base, level.shift, manifest->tree.leaves());
  if (!mesh) return damaged_base(mesh.error().message);
  // What is born whole may bring more.
  const std::uint32_t loops = mesh->connectivity.loop_count();
  if (loops > manifest->loops || (loops < manifest->loops && !manifest->births)) {
    return damaged_base("its boundary loops are not those of the header");
  }
  auto state = std::make_unique<State>();
  state->applied.assign(manifest->chunks.size(), false);
  state->leaf_level.assign(manifest->tree.leaves(), 0);
  state->faces = level.faces;
  state->manifest = std::move(manifest);
  state->mesh = std::move(*mesh);
  return Refiner(std::move(state));
}

const Manifest& Refiner::manifest() const {
  return *state_->manifest;
}
bool Refiner::applied(std::size_t chunk) const {
  return state_->applied[chunk];
}

bool Refiner::ready(std::size_t chunk) const {
  const ChunkInfo& info = state_->manifest->chunks[chunk];
  if (!state_->usable || state_->applied[chunk]) return false;
  const auto has_level = [&](std::uint32_t leaf) {
    return state_->leaf_level[leaf] + 1u >= info.level;
  };
  const RegionNode& region = state_->manifest->region(info);
  for (std::uint32_t leaf = region.first; leaf < region.first + region.leaves; ++leaf) {
    if (!has_level(leaf)) return false;
    const std::vector<std::uint32_t>& next = state_->manifest->adjacency[leaf];
    if (!std::all_of(next.begin(), next.end(), has_level)) return false;
  }
  return true;
}

Expected<void> Refiner::apply(std::size_t chunk, std::span<const std::uint8_t> bytes) {
  State& s = *state_;
  if (chunk >= s.applied.size() || !ready(chunk)) {
    return fail(ErrorCode::kState,
                "this chunk cannot be applied in the present state; apply those before it first");
  }
  const ChunkInfo& info = s.manifest->chunks[chunk];
  if (bytes.size() != info.length) {
    return fail(ErrorCode::kBadInput,
                fill_in("a chunk has {} bytes and the header says {}; fetch it again",
                        {bytes.size(), info.length}));
  }
  s.usable = false;
  s.newest = {};
  auto change = decode_layer(s.mesh, s.frame(info), s.manifest->tree, info.node, bytes);
  if (!change) return tl::unexpected(std::move(change.error()));
  if (s.mesh.connectivity.loop_count() > s.manifest->loops) {
    return fail(ErrorCode::kBadInput,
                "a chunk brings more boundary loops than the header says; fetch the file again");
  }
  s.newest = std::move(*change);
  for (std::size_t i = 0; i < s.newest.splits.size(); ++i)
    s.faces += s.real_faces_of(i);
  for (const Newborn& component : s.newest.components)
    s.faces += component.real_faces;
  const RegionNode& region = s.manifest->region(info);
  std::fill_n(s.leaf_level.begin() + region.first, region.leaves,
              static_cast<std::uint8_t>(info.level));
  s.applied[chunk] = true;
  s.usable = true;
  return {};
}

void Refiner::undo_to_faces(std::uint32_t faces) noexcept {
  State& s = *state_;
  while (s.faces > faces && s.undo_one())
    s.usable = false;
}

std::uint32_t Refiner::vertex_count() const {
  return state_->mesh.vertex_count();
}
std::uint32_t Refiner::face_count() const {
  return state_->faces;
}
std::uint32_t Refiner::level_of(VertexId v) const {
  return state_->leaf_level[state_->mesh.vertex[v].region];
}
std::uint32_t Refiner::region_of(VertexId v) const {
  return state_->mesh.vertex[v].region;
}
VertexId Refiner::parent_of(VertexId v) const {
  const ChunkSplits& splits = state_->newest.splits;
  const bool split_off = v >= splits.first_vertex && v - splits.first_vertex < splits.size();
  return split_off ? splits.v(v - splits.first_vertex) : v;
}
const Connectivity& Refiner::connectivity() const {
  return state_->mesh.connectivity;
}
const Segments<Vec3i>& Refiner::positions() const {
  return state_->mesh.positions;
}
const Segments<Vec3i>& Refiner::colours() const {
  return state_->mesh.colours;
}

Vec3 Refiner::display_position(VertexId v) const {
  return vitrine::display_position(state_->mesh, v, state_->manifest->levels[level_of(v)]);
}

LatticeMesh Refiner::lattice_mesh() const {
  LatticeMesh out{.lattice = state_->manifest->lattice};
  out.positions = state_->mesh.positions.flat();
  out.faces = state_->mesh.real_faces();
  out.colours = state_->mesh.display_colours();
  return out;
}

TriangleMesh Refiner::display_mesh() const {
  TriangleMesh out;
  out.positions.reserve(vertex_count());
  const Lattice& lattice = state_->manifest->lattice;
  for (VertexId v = 0; v < vertex_count(); ++v)
    out.positions.push_back(lattice.origin + display_position(v) * lattice.step);
  out.faces = state_->mesh.real_faces();
  out.colours = state_->mesh.display_colours();
  return out;
}

}  // namespace vitrine
