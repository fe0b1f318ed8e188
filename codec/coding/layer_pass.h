// SPDX-License-Identifier: Apache-2.0
// Codes one chunk, which refines one region from level l - 1 to level l. Encoder and decoder run
// the same pass over the same state, so they cannot diverge. The encoder passes a RangeEncoder,
// which writes each value. The decoder passes a RangeDecoder, which reads it.
//
// If the level's lattice is finer than that of the previous level, the low bits of the region's
// vertices are coded first.
//
// Pass 1 visits the region's vertices in descending lexicographic order of position and codes a
// split flag for each. If the vertex splits, pass 1 also codes the two ring vertices at which the
// ring is cut, and splits the vertex with an estimate of D = V1 - V2. Collapses were made in
// ascending order, so each split finds the same one-ring that its collapse left behind. Pass 2
// codes the exact D of each split.
//
// The contexts of the models do not depend on the order in which regions are refined. If a vertex
// splits, its neighbours in other regions do not split in the same level. The split flag of a
// vertex next to another region (VertexRecord::is_border) is coded without the vertex's
// surroundings.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/coding/attribute_model.h"
#include "codec/coding/cut_model.h"
#include "codec/coding/displacement_model.h"
#include "codec/coding/flag_model.h"
#include "codec/coding/mesh_state.h"
#include "codec/coding/surroundings.h"
#include "codec/coding/visiting_order.h"
#include "codec/coding/wedge_placement.h"
#include "codec/core/expected.h"
#include "codec/format/chunk_frame.h"
#include "codec/format/placement.h"

namespace vitrine::inline codec {

// A split recorded by the encoder. Vertex ids are those of the mesh state.
struct SplitTruth {
  // The new vertex takes the faces from q_i around to q_j. One of q_i and q_j may be virtual.
  VertexId qi = 0, qj = 0;
  Vec3i d;  // cell of v minus cell of the new vertex
  // value at v minus value at the new vertex, for each attribute of the mesh
  AttributeTuple attribute_d{};

  // Negates the differences, because v and the new vertex have swapped roles.
  void negate() {
    d = Vec3i{} - d;
    for (Vec3i& difference : attribute_d)
      difference = Vec3i{} - difference;
  }
};

// `Truth` supplies the values to an encoder. A decoder passes NoTruth.
//  bool find(VertexId v, SplitTruth&)   returns whether v splits; if so, describes the split
//  Vec3i cell(VertexId v)               returns the cell of v on a refined lattice
//  void applied(VertexId v, VertexId w, bool swapped)
//                                       is called after v was split into v and w; `swapped` is
//                                       true if v and w have swapped roles
struct NoTruth {
  bool find(VertexId, SplitTruth&) { return false; }
  Vec3i cell(VertexId) { return {}; }
  void applied(VertexId, VertexId, bool) {}
};

template <class Coder, class Truth>
class LayerPass {
 public:
  LayerPass(MeshState& mesh, const ChunkFrame& frame, Coder& coder, Truth& truth)
      : mesh_(mesh), frame_(frame), coder_(coder), truth_(truth) {}

  Expected<ChunkSplits> run() {
    // Each vertex splits at most once. This check bounds the memory, even if the header states more
    // splits.
    if (frame_.splits > mesh_.members[frame_.region].size()) return damaged("too many splits");
    refine_lattice();
    if (auto ok = split_all(); !ok) return tl::unexpected(ok.error());
    placed_.reserve(chunk_.size());
    while (placed_.size() < chunk_.size()) {
      if (!place()) return damaged("a vertex leaves the lattice");
    }
    if (!mesh_.wedges.empty()) relax_wedges(mesh_, chunk_);
    return std::move(chunk_);
  }

  const FlagModel& flags() const { return flags_; }
  const CutModel& cuts() const { return cuts_; }
  const DisplacementModel& displacements() const { return displacements_; }

 private:
  Unexpected damaged(const char* what) const { return damaged_chunk(frame_, what); }

  // Codes the low bits of the positions if the level's lattice is finer than the previous level's.
  // Codes them without a model: cells are about as large as the previous level's error, so 0 and 1
  // are equally likely.
  void refine_lattice() {
    mesh_.shift = frame_.shift, mesh_.foreign_shift = frame_.shift_before;
    const auto bits = static_cast<int>(frame_.shift_before - frame_.shift);
    if (bits == 0) return;
    const auto refined = [&](std::int32_t coarse, std::int32_t told) {
      const std::uint32_t low = static_cast<std::uint32_t>(told) & ((1u << bits) - 1);
      return coarse << bits | static_cast<std::int32_t>(coder_.raw(low, bits));
    };
    for (const VertexId v : mesh_.members[frame_.region]) {
      const Vec3i coarse = cell_of(mesh_.positions[v], frame_.shift_before);
      const Vec3i told = truth_.cell(v);
      Vec3i fine;
      fine.x = refined(coarse.x, told.x);
      fine.y = refined(coarse.y, told.y);
      fine.z = refined(coarse.z, told.z);
      mesh_.positions[v] = middle_of(fine, frame_.shift);
    }
  }

  Expected<void> split_all() {
    const std::vector<VertexId> order =
        visiting_order(mesh_.positions, mesh_.members[frame_.region]);
    reserve_splits();
    for (std::size_t k = 0; k < order.size(); ++k) {
      mesh_.fetch_rings(order, k);
      if (auto ok = visit(order[k]); !ok) return ok;
    }
    if (chunk_.size() != frame_.splits) return damaged("too few splits");
    return {};
  }

  void reserve_splits() {
    std::vector<VertexId>& members = mesh_.members[frame_.region];
    members.reserve(members.size() + frame_.splits);
    mesh_.wedges.begin_chunk();
    chunk_.first_vertex = mesh_.vertex_count();
    chunk_.first_face = mesh_.connectivity.face_count();
    chunk_.splits.reserve(frame_.splits);
    for (std::size_t i = 0; i < mesh_.attributes.size(); ++i)
      chunk_.merged_attributes[i].reserve(frame_.splits);
    if (frame_.placement == Placement::kPyramid) terms_.reserve(frame_.splits);
  }

  Expected<void> visit(VertexId v) {
    OneRing ring;
    const bool fits = gather_ring(mesh_, v, ring);
    const FlagFeatures features = flag_features(mesh_, v, ring, frame_.level);
    // A vertex whose valence is too high cannot split, so it has no flag. A border vertex always
    // has a flag, because its valence depends on the order in which regions are refined.
    if (!fits && !features.is_border) return {};
    SplitTruth told;
    const bool split = flags_.code(coder_, features, truth_.find(v, told));
    mesh_.vertex[v].visited_level = static_cast<std::uint8_t>(frame_.level);
    if (!split) return {};
    if (!fits) return damaged("a split at too high a valence");
    if (chunk_.size() == frame_.splits) return damaged("too many splits");
    start_canonically(mesh_, ring);
    apply(v, ring, told);
    return {};
  }

  void apply(VertexId v, const OneRing& ring, SplitTruth told) {
    RingCut cut;
    bool is_swapped = false;
    if constexpr (Coder::kEncodes) {
      // Returns the index of q in the ring. All virtual vertices count as equal: a ring has at most
      // one, because a vertex is on at most one boundary loop.
      const auto at = [&](VertexId q) {
        std::uint32_t k = 0;
        while (ring.vertices[k] != q && !(is_virtual(ring.vertices[k]) && is_virtual(q)))
          ++k;
        return k;
      };
      cut = {at(told.qi), at(told.qj)};
      is_swapped = cut.i > cut.j;
      if (is_swapped) std::swap(cut.i, cut.j);
    }
    const RingGeometry around = ring_geometry(mesh_, v, ring);
    cut = cuts_.code(coder_, around, cut);

    const Vec3i merged = mesh_.positions[v];
    for (std::size_t i = 0; i < mesh_.attributes.size(); ++i)
      chunk_.merged_attributes[i].push_back(mesh_.attributes[i].values[v]);
    if (frame_.placement == Placement::kPyramid) terms_.push_back(term(ring, cut));
    const VertexId w = mesh_.connectivity.split(
        v, std::span<const Corner>(ring.corners.data(), ring.size), cut.i, cut.j);
    mesh_.inherit(v);
    update_records(v, w, ring, cut);
    estimate(v, w, merged, CutModel::estimate(around, cut));
    if (!mesh_.wedges.empty()) split_wedges(v, w, merged, ring, cut);
    chunk_.splits.push_back({v, merged});
    if constexpr (Coder::kEncodes) {
      if (is_swapped) told.negate();
      told_.push_back({told.d, told.attribute_d});
    }
    truth_.applied(v, w, is_swapped);
  }

  void update_records(VertexId v, VertexId w, const OneRing& ring, const RingCut& cut) {
    for (const VertexId u : {v, w}) {
      VertexRecord& record = mesh_.vertex[u];
      record.split_level = record.visited_level = static_cast<std::uint8_t>(frame_.level);
      record.split_of = static_cast<std::uint32_t>(chunk_.size());
    }
    if (mesh_.vertex[v].is_border) {
      mesh_.vertex[v].is_border = touches_others(ring, cut.j, cut.i);
      mesh_.vertex[w].is_border = touches_others(ring, cut.i, cut.j);
    }
    const std::uint32_t taken = cut.j - cut.i;
    mesh_.vertex[v].valence = static_cast<std::uint8_t>(ring.size - taken + 2);
    mesh_.vertex[w].valence = static_cast<std::uint8_t>(taken + 2);
    for (const VertexId q : {ring.vertices[cut.i], ring.vertices[cut.j]}) {
      if (!is_virtual(q) && mesh_.vertex[q].valence < 255) ++mesh_.vertex[q].valence;
    }
  }

  // Returns whether any ring vertex from index `from` counter-clockwise to index `to` belongs to
  // another region.
  bool touches_others(const OneRing& ring, std::uint32_t from, std::uint32_t to) const {
    for (std::uint32_t k = from;; k = k + 1 == ring.size ? 0 : k + 1) {
      const VertexId q = ring.vertices[k];
      if (!is_virtual(q) && mesh_.vertex[q].region != frame_.region) return true;
      if (k == to) return false;
    }
  }

  // Moves v and w to their estimated positions, where they stay until pass 2.
  void estimate(VertexId v, VertexId w, const Vec3i& merged, const Vec3& d) {
    const Vec3i half = {exact::round(d.x * 0.5), exact::round(d.y * 0.5), exact::round(d.z * 0.5)};
    mesh_.positions[v] = merged + half;
    mesh_.positions[w] = merged - half;
  }

  void split_wedges(VertexId v, VertexId w, const Vec3i& merged, const OneRing& ring,
                    const RingCut& cut) {
    const auto between = [&](VertexId from, VertexId to) {
      if (is_virtual(from) || is_virtual(to)) return 0.0;
      return length(
          to_vec3(mesh_.seen_from(frame_.region, from) - mesh_.seen_from(frame_.region, to)));
    };
    const VertexId qi = ring.vertices[cut.i], qj = ring.vertices[cut.j];
    mesh_.wedges.split(w, std::span<const Corner>(ring.corners.data(), ring.size), cut.i, cut.j,
                       [&] {
                         return SplitEdgeLengths{.v_qi = between(v, qi),
                                                 .w_qi = between(w, qi),
                                                 .v_qj = between(v, qj),
                                                 .w_qj = between(w, qj),
                                                 .v_w = between(v, w)};
                       });
    place_wedges(mesh_, v, w, merged);
  }

  // Returns the term r of pyramid placement (placement.h). With midpoint placement, all splits have
  // the same r instead.
  Vec3i term(const OneRing& ring, const RingCut& cut) const {
    std::array<Vec3i, kMaxSplitValence> others;
    std::array<Vec3i, 2> opposite;
    std::size_t n = 0, m = 0;
    for (std::uint32_t k = 0; k < ring.size; ++k) {
      if (is_virtual(ring.vertices[k])) continue;
      const Vec3i p = cell_of(mesh_.seen_from(frame_.region, ring.vertices[k]), frame_.shift);
      if (k == cut.i || k == cut.j) {
        opposite[m++] = p;
      } else {
        others[n++] = p;
      }
    }
    return pyramid_term({opposite.data(), m}, {others.data(), n}, frame_.parity);
  }

  // Codes D of the next split and moves the split's two vertices to their final positions.
  bool place() {
    const std::size_t s = placed_.size();
    const SplitSurroundings around = split_surroundings(mesh_, chunk_, placed_);
    PlacedSplit& placed = placed_.emplace_back();
    const Vec3i d =
        displacements_.code(coder_, around, Coder::kEncodes ? told_[s].d : Vec3i{}, placed.error);
    const Vec3i term = terms_.empty() ? midpoint_term(frame_.parity) : terms_[s];
    const SplitPair pair = unmerge(cell_of(chunk_.splits[s].merged, frame_.shift), d, term);
    if (!is_in_coordinate_bound(pair.v1) || !is_in_coordinate_bound(pair.v2)) return false;
    const Vec3i v = middle_of(pair.v1, frame_.shift), w = middle_of(pair.v2, frame_.shift);
    if (!is_in_coordinate_bound(v) || !is_in_coordinate_bound(w)) return false;
    mesh_.positions[chunk_.v(s)] = v;
    mesh_.positions[chunk_.w(s)] = w;
    placed.d = to_vec3(v - w);
    for (std::size_t i = 0; i < mesh_.attributes.size(); ++i) {
      if (!place_attribute(i, s)) return false;
    }
    return true;
  }

  bool place_attribute(std::size_t i, std::size_t s) {
    const Vec3i told = Coder::kEncodes ? told_[s].attribute_d[i] : Vec3i{};
    const Vec3i d = attributes_[i].code(coder_, predicted_difference(mesh_, chunk_, s, i), told);
    const SplitPair pair = unmerge(chunk_.merged_attributes[i][s], d, Vec3i{});
    if (!is_in_coordinate_bound(pair.v1) || !is_in_coordinate_bound(pair.v2)) return false;
    mesh_.attributes[i].values[chunk_.v(s)] = pair.v1;
    mesh_.attributes[i].values[chunk_.w(s)] = pair.v2;
    return true;
  }

  MeshState& mesh_;
  const ChunkFrame frame_;
  Coder& coder_;
  Truth& truth_;
  FlagModel flags_;
  CutModel cuts_;
  DisplacementModel displacements_;
  std::array<AttributeModel, kSemantics> attributes_;  // one entry per attribute of the mesh
  ChunkSplits chunk_;
  std::vector<Vec3i> terms_;         // term r of each split; only for pyramid placement
  std::vector<PlacedSplit> placed_;  // the splits placed so far
  struct ToldDifference {
    Vec3i d;
    AttributeTuple attribute_d;
  };
  std::vector<ToldDifference> told_;  // encoder only: the recorded differences of each split
};

}  // namespace vitrine::inline codec
