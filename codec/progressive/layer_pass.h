// SPDX-License-Identifier: Apache-2.0
// One chunk: turns level l-1 into level l in one region. The encoder and the decoder are the same
// pass over the same state, instantiated with a RangeEncoder that is told the truth or with a
// RangeDecoder that finds it out, so the two cannot drift apart.
//
// Where the level's lattice is finer than the one before, the low bits of the region's vertices
// come first.
//
// Pass 1 visits the region's vertices in descending lexicographic order of their positions (the
// collapses were performed in ascending order, so each split meets the one-ring that its collapse
// left), codes a split flag and the cut pair, and splits with an estimated D. Pass 2 codes the D.
//
// No context depends on the order in which regions are refined: other regions' vertices that are
// next to a vertex which splits do not split in the same level, and where a vertex does not split,
// features of vertices next to another region (MeshState::border) are left out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/chunk_frame.h"
#include "codec/progressive/colour_model.h"
#include "codec/progressive/cut_model.h"
#include "codec/progressive/displacement_model.h"
#include "codec/progressive/flag_model.h"
#include "codec/progressive/mesh_state.h"
#include "codec/progressive/placement.h"
#include "codec/progressive/surroundings.h"
#include "codec/progressive/visiting_order.h"

namespace vitrine {

// What the encoder knows about a vertex that splits, in the ids of the state.
struct SplitTruth {
  VertexId qi = 0, qj = 0;  // the new vertex takes the faces from q_i round to q_j; any virtual one
  Vec3i d;                  // cell of v minus cell of the new vertex
  Vec3i colour_d;           // the same for YCoCg-R
};

// `Truth` tells an encoder what happens; a decoder passes NoTruth.
//   bool find(VertexId v, SplitTruth&)                 does v split, and how
//   Vec3i cell(VertexId v)                             on the level's lattice, if it is a finer one
//   void applied(VertexId v, VertexId w, bool swapped)  w carries what v was told to keep
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
    // Each vertex splits at most once: memory follows the mesh, not what the header says.
    if (frame_.splits > mesh_.members[frame_.region].size()) return damaged("too many splits");
    refine_lattice();
    if (auto ok = split_all(); !ok) return tl::unexpected(std::move(ok.error()));
    errors_.reserve(chunk_.size());
    while (errors_.size() < chunk_.size()) {
      if (!place()) return damaged("a vertex leaves the lattice");
    }
    return std::move(chunk_);
  }

  const FlagModel& flags() const { return flags_; }
  const CutModel& cuts() const { return cuts_; }
  const DisplacementModel& displacements() const { return displacements_; }

 private:
  Unexpected damaged(const char* what) const { return damaged_chunk(frame_, what); }

  // The low bits are as good as random, because a lattice is about as fine as its level is exact.
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
    chunk_.first_vertex = mesh_.vertex_count();
    chunk_.first_face = mesh_.connectivity.face_count();
    chunk_.splits.reserve(frame_.splits);
    if (!mesh_.colours.empty()) chunk_.merged_colours.reserve(frame_.splits);
    if (frame_.placement == Placement::kPyramid) terms_.reserve(frame_.splits);
  }

  Expected<void> visit(VertexId v) {
    Ring ring;
    const bool fits = gather_ring(mesh_, v, ring);
    const FlagFeatures features = flag_features(mesh_, v, ring, frame_.level);
    if (!fits && !features.border) return {};  // its valence is known to be too high
    SplitTruth told;
    const bool split = flags_.code(coder_, features, truth_.find(v, told));
    mesh_.vertex[v].visited_level = static_cast<std::uint8_t>(frame_.level);
    if (!split) return {};
    if (!fits) return damaged("a split at too high a valence");
    if (chunk_.size() == frame_.splits) return damaged("too many splits");
    apply(v, ring, told);
    return {};
  }

  void apply(VertexId v, const Ring& ring, SplitTruth told) {
    Cut cut;
    bool swapped = false;
    if constexpr (Coder::kEncodes) {
      const auto at = [&](VertexId q) {  // no vertex is on two boundary loops
        std::uint32_t k = 0;
        while (ring.vertices[k] != q && !(is_virtual(ring.vertices[k]) && is_virtual(q)))
          ++k;
        return k;
      };
      cut = {at(told.qi), at(told.qj)};
      swapped = cut.i > cut.j;
      if (swapped) std::swap(cut.i, cut.j);
    }
    const CutRing around = cut_ring(mesh_, v, ring);
    cut = cuts_.code(coder_, around, cut);

    const Vec3i merged = mesh_.positions[v];
    if (!mesh_.colours.empty()) chunk_.merged_colours.push_back(mesh_.colours[v]);
    if (frame_.placement == Placement::kPyramid) terms_.push_back(term(ring, cut));
    const VertexId w = mesh_.connectivity.split(
        v, std::span<const Corner>(ring.corners.data(), ring.size), cut.i, cut.j);
    mesh_.inherit(v);
    update_records(v, w, ring, cut);
    estimate(v, w, merged, CutModel::estimate(around, cut));
    chunk_.splits.push_back({v, merged});
    if constexpr (Coder::kEncodes) {
      const Vec3i none;
      told_.push_back(swapped ? std::pair(none - told.d, none - told.colour_d)
                              : std::pair(told.d, told.colour_d));
    }
    truth_.applied(v, w, swapped);
  }

  void update_records(VertexId v, VertexId w, const Ring& ring, const Cut& cut) {
    for (const VertexId u : {v, w}) {
      VertexRecord& record = mesh_.vertex[u];
      record.split_level = record.visited_level = static_cast<std::uint8_t>(frame_.level);
      record.split_of = static_cast<std::uint32_t>(chunk_.size());
      if (record.border) mesh_.mark_border(u);
    }
    const std::uint32_t taken = cut.j - cut.i;
    mesh_.vertex[v].valence = static_cast<std::uint8_t>(ring.size - taken + 2);
    mesh_.vertex[w].valence = static_cast<std::uint8_t>(taken + 2);
    for (const VertexId q : {ring.vertices[cut.i], ring.vertices[cut.j]}) {
      if (!is_virtual(q) && mesh_.vertex[q].valence < 255) ++mesh_.vertex[q].valence;
    }
  }

  // Until pass 2 the two vertices stand where they are expected.
  void estimate(VertexId v, VertexId w, const Vec3i& merged, const Vec3& d) {
    const Vec3i half = {exact::round(d.x * 0.5), exact::round(d.y * 0.5), exact::round(d.z * 0.5)};
    mesh_.positions[v] = merged + half;
    mesh_.positions[w] = merged - half;
  }

  // Of the pyramid placement; the midpoint's is the same for all.
  Vec3i term(const Ring& ring, const Cut& cut) const {
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

  // The next split whose vertices are still where they are expected.
  bool place() {
    const std::size_t s = errors_.size();
    const SplitSurroundings around = split_surroundings(mesh_, chunk_, errors_);
    const Vec3i d = displacements_.code(coder_, around, Coder::kEncodes ? told_[s].first : Vec3i{},
                                        errors_.emplace_back());
    const Vec3i term = terms_.empty() ? midpoint_term(frame_.parity) : terms_[s];
    const SplitPair pair = unmerge(cell_of(chunk_.splits[s].merged, frame_.shift), d, term);
    if (!in_coordinate_bound(pair.v1) || !in_coordinate_bound(pair.v2)) return false;
    const Vec3i v = middle_of(pair.v1, frame_.shift), w = middle_of(pair.v2, frame_.shift);
    if (!in_coordinate_bound(v) || !in_coordinate_bound(w)) return false;
    mesh_.positions[chunk_.v(s)] = v;
    mesh_.positions[chunk_.w(s)] = w;
    return mesh_.colours.empty() || place_colour(s);
  }

  bool place_colour(std::size_t s) {
    const Vec3i told = Coder::kEncodes ? told_[s].second : Vec3i{};
    const Vec3i d = colours_.code(coder_, colour_difference(mesh_, chunk_, s), told);
    const SplitPair pair = unmerge(chunk_.merged_colours[s], d, Vec3i{});
    if (!in_coordinate_bound(pair.v1) || !in_coordinate_bound(pair.v2)) return false;
    mesh_.colours[chunk_.v(s)] = pair.v1;
    mesh_.colours[chunk_.w(s)] = pair.v2;
    return true;
  }

  MeshState& mesh_;
  const ChunkFrame frame_;
  Coder& coder_;
  Truth& truth_;
  FlagModel flags_;
  CutModel cuts_;
  DisplacementModel displacements_;
  ColourModel colours_;
  ChunkSplits chunk_;
  std::vector<Vec3i> terms_;        // r of each split where the placement is the pyramid's
  std::vector<SplitError> errors_;  // of the splits placed so far
  std::vector<std::pair<Vec3i, Vec3i>> told_;  // encoder: D of position and of colour
};

}  // namespace vitrine
