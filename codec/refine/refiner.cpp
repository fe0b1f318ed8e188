// SPDX-License-Identifier: Apache-2.0
#include "codec/refine/refiner.h"

#include <algorithm>

#include "codec/coding/layer_decoder.h"
#include "codec/coding/mesh_state.h"
#include "codec/core/fill_in.h"
#include "codec/refine/display_filter.h"

namespace vitrine::inline codec {

struct Refiner::State {
  std::shared_ptr<const Manifest> manifest;
  MeshState mesh;
  std::vector<std::uint8_t> applied;
  std::vector<std::uint8_t> leaf_level;  // current level of each leaf of the region tree
  LayerChange newest;                    // the change made by the last applied chunk
  std::uint32_t faces = 0;               // real faces, without virtual ones
  bool is_usable = true;

  ChunkFrame frame(const ChunkInfo& chunk) const;
  // Returns how many of the two faces added by a split of `newest` are real faces.
  std::uint32_t real_faces_of(std::size_t split) const {
    const std::uint32_t face = newest.splits.face(split);
    return (mesh.connectivity.is_real(face) ? 1 : 0) +
           (mesh.connectivity.is_real(face + 1) ? 1 : 0);
  }
  // Undoes the last component insertion or split of `newest`. Returns false if none is left.
  bool undo_one();
};

ChunkFrame Refiner::State::frame(const ChunkInfo& chunk) const {
  const auto last = static_cast<std::uint32_t>(manifest->levels.size() - 1);
  return {.level = chunk.level,
          .region = static_cast<std::uint16_t>(chunk.region),
          .splits = chunk.splits,
          .inserted = chunk.inserted,
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
  if (!mesh.wedges.empty()) mesh.wedges.undo(mesh.connectivity, split.v, newest.splits.w(last));
  mesh.connectivity.unsplit(split.v);
  mesh.disinherit();
  mesh.positions[split.v] = split.merged;
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i)
    mesh.attributes[i].values[split.v] = newest.splits.merged_attributes[i][last];
  newest.splits.splits.pop_back();
  return true;
}

Refiner::Refiner(std::unique_ptr<State> state) : state_(std::move(state)) {}
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;
Refiner::~Refiner() = default;

Expected<Refiner> Refiner::start(std::shared_ptr<const Manifest> manifest, const BaseMesh& base) {
  const LevelInfo& level = manifest->levels[0];
  if (base.positions.size() != level.vertices || base.faces.size() != level.faces ||
      !has_all(base.attributes, manifest->attributes, level.vertices)) {
    return damaged_base("its counts are not those of the header");
  }
  auto mesh = MeshState::from_base(base, level.shift, manifest->tree.leaves());
  if (!mesh) return damaged_base(mesh.error().message);
  // The base mesh may have fewer loops than the finest level only if components are inserted later.
  const std::uint32_t loops = mesh->connectivity.loop_count();
  if (loops > manifest->loops || (loops < manifest->loops && !manifest->has_insertions)) {
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
bool Refiner::is_applied(std::size_t chunk) const {
  return state_->applied[chunk];
}

bool Refiner::is_ready(std::size_t chunk) const {
  const ChunkInfo& info = state_->manifest->chunks[chunk];
  if (!state_->is_usable || state_->applied[chunk]) return false;
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
  if (chunk >= s.applied.size() || !is_ready(chunk)) {
    return fail(ErrorCode::kState,
                "this chunk cannot be applied in the present state; apply those before it first");
  }
  const ChunkInfo& info = s.manifest->chunks[chunk];
  if (bytes.size() != info.length) {
    return fail(ErrorCode::kBadInput,
                fill_in("a chunk has {} bytes and the header says {}; fetch it again",
                        {bytes.size(), info.length}));
  }
  s.is_usable = false;
  s.newest = {};
  auto change = decode_layer(s.mesh, s.frame(info), s.manifest->tree, info.node, bytes);
  if (!change) return tl::unexpected(change.error());
  if (s.mesh.connectivity.loop_count() > s.manifest->loops) {
    return fail(ErrorCode::kBadInput,
                "a chunk brings more boundary loops than the header says; fetch the file again");
  }
  s.newest = std::move(*change);
  for (std::size_t i = 0; i < s.newest.splits.size(); ++i)
    s.faces += s.real_faces_of(i);
  for (const InsertedComponent& component : s.newest.components)
    s.faces += component.real_faces;
  const RegionNode& region = s.manifest->region(info);
  std::fill_n(s.leaf_level.begin() + region.first, region.leaves,
              static_cast<std::uint8_t>(info.level));
  s.applied[chunk] = true;
  s.is_usable = true;
  return {};
}

void Refiner::undo_to_faces(std::uint32_t faces) noexcept {
  State& s = *state_;
  while (s.faces > faces && s.undo_one())
    s.is_usable = false;
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
const AttributeColumns<Segments<Vec3i>>& Refiner::attributes() const {
  return state_->mesh.attributes;
}

const Wedges& Refiner::wedges() const {
  return state_->mesh.wedges;
}

std::vector<std::array<TextureCoordinates, 3>> Refiner::texture_coordinates() const {
  std::vector<std::array<TextureCoordinates, 3>> out;
  const Connectivity& faces = state_->mesh.connectivity;
  if (wedges().empty()) return out;
  const auto side = static_cast<float>(state_->manifest->texture.side);
  const auto at = [&](Corner c) -> TextureCoordinates {
    const Vec2i uv = wedges()[wedges().of(c)].at;
    return {static_cast<float>(uv.x) / side, static_cast<float>(uv.y) / side};
  };
  for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
    if (faces.is_real(f)) out.push_back({at(3 * f), at(3 * f + 1), at(3 * f + 2)});
  }
  return out;
}

Vec3 Refiner::display_position(VertexId v) const {
  return vitrine::display_position(state_->mesh, v, state_->manifest->levels[level_of(v)]);
}

LatticeMesh Refiner::lattice_mesh() const {
  LatticeMesh out{.lattice = state_->manifest->lattice};
  out.positions = state_->mesh.positions.flat();
  out.faces = state_->mesh.real_faces();
  out.attributes = display_attributes(state_->mesh.attributes);
  return out;
}

TriangleMesh Refiner::display_mesh() const {
  TriangleMesh out;
  out.positions.reserve(vertex_count());
  const Lattice& lattice = state_->manifest->lattice;
  for (VertexId v = 0; v < vertex_count(); ++v)
    out.positions.push_back(lattice.origin + display_position(v) * lattice.step);
  out.faces = state_->mesh.real_faces();
  out.attributes = display_attributes(state_->mesh.attributes);
  return out;
}

}  // namespace vitrine::inline codec
