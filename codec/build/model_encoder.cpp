// SPDX-License-Identifier: Apache-2.0
#include "codec/build/model_encoder.h"

#include <algorithm>

#include "codec/base/base_encoder.h"
#include "codec/coding/layer_encoder.h"

namespace vitrine::inline codec {
namespace {

Manifest frame_of(const Hierarchy& hierarchy) {
  Manifest m{.lattice = hierarchy.base.lattice, .placement = hierarchy.placement};
  m.attributes = semantics_of(hierarchy.base_attributes);
  m.has_insertions =
      std::ranges::any_of(hierarchy.insertions, [](const auto& level) { return !level.empty(); });
  m.loops = hierarchy.loops;
  m.tree = hierarchy.tree;
  m.adjacency = hierarchy.adjacency;
  return m;
}

void add_level(const MeshState& level, Manifest& manifest) {
  manifest.levels.push_back(
      {.vertices = level.vertex_count(), .faces = level.real_face_count(), .shift = level.shift});
}

// Enlarges the bounding box of each region of `level` to include all faces at the region's
// vertices. A face between two regions enlarges the boxes of both. The boxes are therefore valid
// for every order in which regions are refined.
void add_to_boxes(const MeshState& mesh, std::uint32_t level, RegionTree& tree) {
  std::vector<LatticeBox*> box(tree.leaves(), nullptr);
  for (const std::uint32_t node : tree.regions_at(level))
    box[tree.nodes[node].first] = &tree.nodes[node].box;
  const Connectivity& faces = mesh.connectivity;
  for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
    if (!faces.is_real(f)) continue;
    LatticeBox face = LatticeBox::none();
    for (Corner c = 3 * f; c < 3 * f + 3; ++c)
      face.add({mesh.positions[faces.vertex(c)], mesh.positions[faces.vertex(c)]});
    for (Corner c = 3 * f; c < 3 * f + 3; ++c)
      box[mesh.vertex[faces.vertex(c)].region]->add(face);
  }
}

void close_boxes(RegionTree& tree) {
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    RegionNode& node = tree.nodes[i];
    if (node.fork == 0) continue;
    node.box.add(tree.nodes[i + 1].box);
    node.box.add(tree.nodes[node.second].box);
  }
}

void add_chunk(const EncodedChunk& chunk, std::uint32_t level, EncodedModel& model) {
  model.manifest.chunks.push_back({.level = level,
                                   .region = model.manifest.tree.nodes[chunk.node].first,
                                   .node = chunk.node,
                                   .length = chunk.bytes.size(),
                                   .splits = chunk.splits,
                                   .inserted = chunk.inserted,
                                   .sha256 = sha256(chunk.bytes)});
  model.body.insert(model.body.end(), chunk.bytes.begin(), chunk.bytes.end());
}

// Writes the encoded base mesh at the start of the body. Returns an encoder whose state is the base
// mesh.
Expected<LayerEncoder> start_with_base(const Hierarchy& hierarchy, EncodedModel& model) {
  auto base = encode_base({.positions = hierarchy.base.positions,
                           .faces = hierarchy.base.faces,
                           .attributes = hierarchy.base_attributes});
  if (!base) return tl::unexpected(base.error());
  model.manifest.base_length = base->bytes.size();
  model.manifest.base_sha256 = sha256(base->bytes);
  std::vector<VertexId> fine_ids;
  for (const std::uint32_t v : base->original)
    fine_ids.push_back(hierarchy.base_ids[v]);
  model.body = std::move(base->bytes);
  model.base = std::move(base->decoded);
  return LayerEncoder::start(hierarchy, model.base, std::move(fine_ids));
}

}  // namespace

Expected<EncodedModel> encode_model(Hierarchy hierarchy, const LevelSink& on_level) {
  EncodedModel model{.manifest = frame_of(hierarchy), .body = {}};
  auto encoder = start_with_base(hierarchy, model);
  if (!encoder) return tl::unexpected(encoder.error());
  RegionTree& tree = model.manifest.tree;
  for (RegionNode& node : tree.nodes)
    node.box = LatticeBox::none();
  add_to_boxes(encoder->mesh(), 1, tree);
  add_level(encoder->mesh(), model.manifest);
  on_level(encoder->mesh());
  for (std::uint32_t level = 1; level <= hierarchy.levels.size(); ++level) {
    const auto chunks = encoder->encode_level();
    if (!chunks) return tl::unexpected(chunks.error());
    for (const EncodedChunk& chunk : *chunks)
      add_chunk(chunk, level, model);
    hierarchy.levels[level - 1] = {};
    hierarchy.insertions[level - 1] = {};
    add_to_boxes(encoder->mesh(), level + 1, tree);
    add_level(encoder->mesh(), model.manifest);
    on_level(encoder->mesh());
  }
  close_boxes(tree);
  model.fine_ids = encoder->fine_ids();
  return model;
}

}  // namespace vitrine::inline codec
