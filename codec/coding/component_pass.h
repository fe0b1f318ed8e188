// SPDX-License-Identifier: Apache-2.0
// Codes the components that a chunk inserts after its splits. Each component grows from its first
// triangle across its open edges ("gates"), in the order in which these edges appear. The encoder
// and the decoder run the same pass.
//
// No inserted component touches an existing vertex, and the pass uses no existing vertex as
// context. The inserted components are therefore the same for every order in which regions are
// refined.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "codec/coding/component_model.h"
#include "codec/coding/mesh_state.h"
#include "codec/core/expected.h"
#include "codec/format/chunk_frame.h"

namespace vitrine::inline codec {

// The directed edges of a component, stored as bits. For each vertex, one 64-bit word holds the
// edges that leave the vertex, and another word holds the edges that enter it.
class EdgeSet {
 public:
  void add(std::uint32_t from, std::uint32_t to) {
    out_[from] |= std::uint64_t{1} << to, in_[to] |= std::uint64_t{1} << from;
  }
  bool has(std::uint32_t from, std::uint32_t to) const { return (out_[from] >> to & 1) != 0; }
  // Returns the vertices that may complete a face with the edge from -> to, as one bit per vertex.
  // All of them are on open edges.
  std::uint64_t thirds(std::uint32_t from, std::uint32_t to, std::uint32_t vertices) const {
    std::uint64_t open = 0;
    for (std::uint32_t v = 0; v < vertices; ++v)
      open |= std::uint64_t{out_[v] != in_[v]} << v;
    const std::uint64_t ends = std::uint64_t{1} << from | std::uint64_t{1} << to;
    return open & ~ends & ~out_[to] & ~in_[from];
  }

 private:
  std::array<std::uint64_t, kMostInserted> out_{}, in_{};
};

inline constexpr std::uint32_t kNoThird = 0xFFFF'FFFFu;

// `Truth` supplies the values to an encoder. A decoder passes NoComponentTruth. The vertices of a
// component are numbered in the order in which the pass reaches them.
//  void next()                 proceeds to the next component; its first face is (0, 1, 2)
//  uint32 third(from, to)      returns the third vertex of the face at this edge, or kNoThird if
//                              there is none; a new vertex gets the next number
//  Vec3i cell(v)               returns the cell of vertex v
//  Vec3i value(i, v)           returns the i-th attribute of vertex v
//  void added()                is called once the component has been added to the mesh state
struct NoComponentTruth {
  void next() {}
  std::uint32_t third(std::uint32_t, std::uint32_t) { return kNoThird; }
  Vec3i cell(std::uint32_t) { return {}; }
  Vec3i value(std::size_t, std::uint32_t) { return {}; }
  void added() {}
};

template <class Coder, class Truth>
class ComponentPass {
 public:
  ComponentPass(MeshState& mesh, const ChunkFrame& frame, Coder& coder, Truth& truth)
      : mesh_(mesh), frame_(frame), coder_(coder), truth_(truth), left_(frame.inserted) {
    add_columns(part_.attributes, mesh.attributes);
  }

  Expected<std::vector<InsertedComponent>> run() {
    std::vector<InsertedComponent> components;
    components.reserve(left_ / 3);
    auto& members = mesh_.members[frame_.region];
    members.reserve(members.size() + left_);
    while (left_ > 0) {
      if (!code_component()) return damaged_chunk(frame_, "a component that is none");
      const std::uint32_t faces = mesh_.connectivity.face_count();
      const std::uint32_t loops = mesh_.connectivity.loop_count();
      auto ok = mesh_.add(part_, frame_.region, static_cast<std::uint8_t>(frame_.level));
      if (!ok) return damaged_chunk(frame_, ok.error().message);
      components.push_back({static_cast<std::uint8_t>(part_.positions.size()),
                            static_cast<std::uint8_t>(mesh_.connectivity.face_count() - faces),
                            static_cast<std::uint8_t>(part_.faces.size()),
                            static_cast<std::uint8_t>(mesh_.connectivity.loop_count() - loops)});
      truth_.added();
    }
    return components;
  }

 private:
  using ComponentEdge = std::pair<std::uint32_t, std::uint32_t>;

  bool code_component() {
    part_.positions.clear();
    part_.faces.clear();
    for (auto& column : part_.attributes)
      column.values.clear();
    edges_ = {};
    gates_.clear();
    if (left_ < 3) return false;
    truth_.next();
    for (std::uint32_t v = 0; v < 3; ++v) {
      if (!add_vertex(v == 0 ? first_ : part_.positions[0])) return false;
    }
    add_face(0, 1, 2);
    for (std::size_t g = 0; g < gates_.size(); ++g) {
      if (!pass(gates_[g])) return false;
    }
    first_ = part_.positions[0];
    for (std::size_t i = 0; i < part_.attributes.size(); ++i)
      first_values_[i] = part_.attributes[i].values[0];
    return part_.faces.size() <= 2 * part_.positions.size();
  }

  // Codes whether a face lies across the open edge `gate`. If so, codes its third vertex and adds
  // the face. Returns false if the data is damaged.
  bool pass(ComponentEdge gate) {
    const auto [from, to] = gate;
    if (edges_.has(from, to)) return true;  // this edge already has a face
    const auto met = static_cast<std::uint32_t>(part_.positions.size());
    const std::size_t faces = part_.faces.size();
    const std::uint64_t known = edges_.thirds(from, to, met);
    const bool has_room = left_ > 0 && met < kMostInserted;
    if (known == 0 && !has_room) return true;
    const std::uint32_t third = truth_.third(from, to);
    if (model_.gates.code_boundary(coder_, faces, third == kNoThird)) return true;
    const bool is_new =
        known == 0 || (has_room && model_.gates.code_new(coder_, faces, third == met));
    if (is_new && !add_vertex(middle(gate))) return false;
    add_face(from, to, is_new ? met : code_known(gate, known, third));
    return true;
  }

  // Codes which of the `known` vertices is the face's third vertex. Codes one flag per vertex until
  // the right vertex is found. The last vertex needs no flag.
  std::uint32_t code_known(ComponentEdge gate, std::uint64_t known, std::uint32_t third) {
    for (;;) {
      const auto v = static_cast<std::uint32_t>(std::countr_zero(known));
      known &= known - 1;
      const int sides = (edges_.has(v, gate.second) ? 1 : 0) + (edges_.has(gate.first, v) ? 1 : 0);
      if (known == 0 || model_.gates.code_known(coder_, sides, v == third)) return v;
    }
  }

  Vec3i middle(ComponentEdge edge) const {
    const Vec3i sum = part_.positions[edge.first] + part_.positions[edge.second];
    return {sum.x >> 1, sum.y >> 1, sum.z >> 1};
  }

  bool add_vertex(const Vec3i& expected) {
    const auto v = static_cast<std::uint32_t>(part_.positions.size());
    TripleModel& cells = v == 0 ? model_.cells.first : model_.cells.other;
    part_.positions.push_back(cells.code(coder_, expected, truth_.cell(v)));
    --left_;
    if (!is_in_coordinate_bound(part_.positions[v])) return false;
    for (std::size_t i = 0; i < part_.attributes.size(); ++i) {
      if (!add_value(i, v)) return false;
    }
    return true;
  }

  bool add_value(std::size_t i, std::uint32_t v) {
    std::vector<Vec3i>& values = part_.attributes[i].values;
    TripleModel& model = v == 0 ? model_.attributes[i].first : model_.attributes[i].other;
    const Vec3i& expected = v == 0 ? first_values_[i] : values[0];
    values.push_back(model.code(coder_, expected, truth_.value(i, v)));
    return is_in_coordinate_bound(values[v]);
  }

  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    part_.faces.push_back({a, b, c});
    for (const auto& [from, to] : {ComponentEdge(a, b), ComponentEdge(b, c), ComponentEdge(c, a)}) {
      edges_.add(from, to);
      gates_.emplace_back(to, from);
    }
  }

  MeshState& mesh_;
  const ChunkFrame frame_;
  Coder& coder_;
  Truth& truth_;
  std::uint32_t left_;  // number of vertices still to be coded
  ComponentModel model_;
  Vec3i first_;                    // cell of the previous component's first vertex
  AttributeTuple first_values_{};  // attributes of the previous component's first vertex
  BaseMesh part_;                  // the component being coded
  EdgeSet edges_;
  std::vector<ComponentEdge> gates_;
};

}  // namespace vitrine::inline codec
