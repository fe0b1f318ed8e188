// SPDX-License-Identifier: Apache-2.0
// The components that a chunk brings whole, behind its splits: each grows from its first triangle
// over the open edges ("gates") of what is known, first come, first served. One pass for the
// encoder and the decoder, as LayerPass.
//
// Nothing here depends on vertices that were there before, and the new ones are next to none of
// them: any order of regions gives the same components.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/birth_model.h"
#include "codec/progressive/chunk_frame.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

// Edges of a component whose vertices are numbered from 0 on, as bits: those that leave a vertex
// and those that come to it.
class EdgeSet {
 public:
  void add(std::uint32_t from, std::uint32_t to) {
    out_[from] |= std::uint64_t{1} << to, in_[to] |= std::uint64_t{1} << from;
  }
  bool has(std::uint32_t from, std::uint32_t to) const { return (out_[from] >> to & 1) != 0; }
  // Which of the vertices are on an open edge and may be the third of a face with from -> to.
  std::uint64_t thirds(std::uint32_t from, std::uint32_t to, std::uint32_t vertices) const {
    std::uint64_t open = 0;
    for (std::uint32_t v = 0; v < vertices; ++v)
      open |= std::uint64_t{out_[v] != in_[v]} << v;
    const std::uint64_t ends = std::uint64_t{1} << from | std::uint64_t{1} << to;
    return open & ~ends & ~out_[to] & ~in_[from];
  }

 private:
  std::array<std::uint64_t, kMostNewborn> out_{}, in_{};
};

inline constexpr std::uint32_t kNoThird = 0xFFFF'FFFFu;

// `Truth` tells an encoder what happens; a decoder passes NoBirthTruth. Vertices of a component are
// numbered as they are met.
//   void next()                 the next component; its first face is 0 1 2
//   uint32 third(from, to)      third vertex of the face with that edge, or kNoThird; one that was
//                               not met yet gets the next number
//   Vec3i cell(v), colour(v)
//   void added()                the component is the newest of the state
struct NoBirthTruth {
  void next() {}
  std::uint32_t third(std::uint32_t, std::uint32_t) { return kNoThird; }
  Vec3i cell(std::uint32_t) { return {}; }
  Vec3i colour(std::uint32_t) { return {}; }
  void added() {}
};

template <class Coder, class Truth>
class BirthPass {
 public:
  BirthPass(MeshState& mesh, const ChunkFrame& frame, Coder& coder, Truth& truth)
      : mesh_(mesh), frame_(frame), coder_(coder), truth_(truth), left_(frame.newborn) {}

  Expected<std::vector<Newborn>> run() {
    std::vector<Newborn> components;
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
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  bool code_component() {
    part_ = {};
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
    if (!part_.colours.empty()) first_colour_ = part_.colours[0];
    return part_.faces.size() <= 2 * part_.positions.size();
  }

  // Codes the face behind an open edge.
  bool pass(Edge gate) {
    const auto [from, to] = gate;
    if (edges_.has(from, to)) return true;  // another face came to it
    const auto met = static_cast<std::uint32_t>(part_.positions.size());
    const std::size_t faces = part_.faces.size();
    const std::uint64_t known = edges_.thirds(from, to, met);
    const bool has_room = left_ > 0 && met < kMostNewborn;
    if (known == 0 && !has_room) return true;
    const std::uint32_t third = truth_.third(from, to);
    if (model_.gates.code_boundary(coder_, faces, third == kNoThird)) return true;
    const bool is_new =
        known == 0 || (has_room && model_.gates.code_new(coder_, faces, third == met));
    if (is_new && !add_vertex(middle(gate))) return false;
    add_face(from, to, is_new ? met : code_known(gate, known, third));
    return true;
  }

  // The first of the `known` vertices that is said to be it; the last one goes without saying.
  std::uint32_t code_known(Edge gate, std::uint64_t known, std::uint32_t third) {
    for (;;) {
      const auto v = static_cast<std::uint32_t>(std::countr_zero(known));
      known &= known - 1;
      const int sides = (edges_.has(v, gate.second) ? 1 : 0) + (edges_.has(gate.first, v) ? 1 : 0);
      if (known == 0 || model_.gates.code_known(coder_, sides, v == third)) return v;
    }
  }

  Vec3i middle(Edge edge) const {
    const Vec3i sum = part_.positions[edge.first] + part_.positions[edge.second];
    return {sum.x >> 1, sum.y >> 1, sum.z >> 1};
  }

  bool add_vertex(const Vec3i& expected) {
    const auto v = static_cast<std::uint32_t>(part_.positions.size());
    TripleModel& cells = v == 0 ? model_.first : model_.other;
    part_.positions.push_back(cells.code(coder_, expected, truth_.cell(v)));
    --left_;
    if (!in_coordinate_bound(part_.positions[v])) return false;
    if (mesh_.colours.empty()) return true;
    TripleModel& colours = v == 0 ? model_.first_colour : model_.other_colour;
    const Vec3i& like = v == 0 ? first_colour_ : part_.colours[0];
    part_.colours.push_back(colours.code(coder_, like, truth_.colour(v)));
    return in_coordinate_bound(part_.colours[v]);
  }

  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    part_.faces.push_back({a, b, c});
    for (const auto& [from, to] : {Edge(a, b), Edge(b, c), Edge(c, a)}) {
      edges_.add(from, to);
      gates_.emplace_back(to, from);
    }
  }

  MeshState& mesh_;
  const ChunkFrame frame_;
  Coder& coder_;
  Truth& truth_;
  std::uint32_t left_;  // vertices still to come
  BirthModel model_;
  Vec3i first_, first_colour_;  // of the component before
  BaseMesh part_;               // the component at hand
  EdgeSet edges_;
  std::vector<Edge> gates_;
};

}  // namespace vitrine
