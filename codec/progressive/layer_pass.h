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
#include "codec/progressive/colour_model.h"
#include "codec/progressive/cut_model.h"
#include "codec/progressive/displacement_model.h"
#include "codec/progressive/flag_model.h"
#include "codec/progressive/manifest.h"
#include "codec/progressive/mesh_state.h"
#include "codec/progressive/placement.h"
#include "codec/progressive/surroundings.h"

namespace vitrine {

// What the encoder knows about a vertex that splits, in the ids of the state.
struct SplitTruth {
  VertexId qi = 0, qj = 0;  // the new vertex takes the faces from q_i round to q_j
  Vec3i d;                  // cell of v minus cell of the new vertex
  Vec3i colour_d;           // the same for YCoCg-R
};

struct ChunkFrame {
  std::uint32_t level = 1;
  std::uint16_t region = 0;
  std::uint32_t splits = 0;                   // stated by the header
  std::uint32_t shift = 0, shift_before = 0;  // of this level's lattice and of the one before
  Placement placement = Placement::kMidpoint;
  std::int32_t parity = 0;  // level_parity()
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

  Expected<std::vector<Split>> run() {
    // Each vertex splits at most once: memory follows the mesh, not what the header says.
    if (frame_.splits > mesh_.members[frame_.region].size()) return damaged("too many splits");
    refine_lattice();
    splits_.reserve(frame_.splits);
    for (const VertexId v : visiting_order()) {
      if (auto ok = visit(v); !ok) return tl::unexpected(ok.error());
    }
    if (splits_.size() != frame_.splits) return damaged("too few splits");
    for (std::size_t s = 0; s < splits_.size(); ++s) {
      if (!place(s)) return damaged("a vertex leaves the lattice");
    }
    return std::move(splits_);
  }

  const FlagModel& flags() const { return flags_; }
  const CutModel& cuts() const { return cuts_; }
  const DisplacementModel& displacements() const { return displacements_; }

 private:
  Unexpected damaged(const char* what) const {
    return fail(ErrorCode::kBadInput, "damaged chunk (level " + std::to_string(frame_.level) +
                                          ", region " + std::to_string(frame_.region) +
                                          "): " + what);
  }

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

  std::vector<VertexId> visiting_order() const {
    const auto& members = mesh_.members[frame_.region];
    std::vector<std::pair<std::uint64_t, VertexId>> keyed;
    keyed.reserve(members.size());
    for (const VertexId v : members)
      keyed.emplace_back(order_key(mesh_.positions[v]), v);
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<VertexId> order;
    order.reserve(keyed.size());
    for (const auto& [key, v] : keyed)
      order.push_back(v);
    return order;
  }

  static std::uint64_t order_key(const Vec3i& p) {
    const auto part = [](std::int32_t c) {
      return static_cast<std::uint64_t>(std::int64_t{c} + kCoordinateBound);
    };
    return part(p.x) << 42 | part(p.y) << 21 | part(p.z);
  }

  Expected<void> visit(VertexId v) {
    Ring ring;
    const bool fits = gather_ring(mesh_, v, ring);
    const FlagFeatures features = flag_features(mesh_, v, ring, frame_.level);
    if (!fits && !features.border) return {};  // its valence is known to be too high
    SplitTruth told;
    const bool split = flags_.code(coder_, features, truth_.find(v, told));
    mesh_.visited_level[v] = static_cast<std::uint8_t>(frame_.level);
    if (!split) return {};
    if (!fits) return damaged("a split at too high a valence");
    if (splits_.size() == frame_.splits) return damaged("too many splits");
    apply(v, ring, told);
    return {};
  }

  void apply(VertexId v, const Ring& ring, SplitTruth told) {
    Cut cut;
    bool swapped = false;
    if constexpr (Coder::kEncodes) {
      const auto at = [&](VertexId q) {
        return static_cast<std::uint32_t>(
            std::find(ring.vertices.begin(), ring.vertices.begin() + ring.size, q) -
            ring.vertices.begin());
      };
      cut = {at(told.qi), at(told.qj)};
      swapped = cut.i > cut.j;
      if (swapped) std::swap(cut.i, cut.j);
    }
    const CutRing around = cut_ring(mesh_, v, ring);
    cut = cuts_.code(coder_, around, cut);

    Split split{.v = v, .merged = mesh_.positions[v], .new_face = mesh_.connectivity.face_count()};
    if (!mesh_.colours.empty()) split.merged_colour = mesh_.colours[v];
    split.term = term(ring, cut);
    split.w = mesh_.connectivity.split(v, std::span<const Corner>(ring.corners.data(), ring.size),
                                       cut.i, cut.j);
    mesh_.inherit(v);
    update_marks(split, ring, cut);
    estimate(split, CutModel::estimate(around, cut));
    splits_.push_back(split);
    if constexpr (Coder::kEncodes) {
      const Vec3i none;
      told_.push_back(swapped ? std::pair(none - told.d, none - told.colour_d)
                              : std::pair(told.d, told.colour_d));
    }
    truth_.applied(v, split.w, swapped);
  }

  void update_marks(const Split& split, const Ring& ring, const Cut& cut) {
    const auto own = static_cast<std::uint32_t>(splits_.size());
    for (const VertexId u : {split.v, split.w}) {
      mesh_.split_level[u] = mesh_.visited_level[u] = static_cast<std::uint8_t>(frame_.level);
      mesh_.split_of[u] = own;
      if (mesh_.border[u] != 0) mesh_.mark_border(u);
    }
    const std::uint32_t taken = cut.j - cut.i;
    mesh_.valence[split.v] = static_cast<std::uint8_t>(ring.size - taken + 2);
    mesh_.valence[split.w] = static_cast<std::uint8_t>(taken + 2);
    for (const VertexId q : {ring.vertices[cut.i], ring.vertices[cut.j]}) {
      if (!is_virtual(q) && mesh_.valence[q] < 255) ++mesh_.valence[q];
    }
  }

  // Until pass 2 the two vertices stand where they are expected.
  void estimate(const Split& split, const Vec3& d) {
    const Vec3i half = {exact::round(d.x * 0.5), exact::round(d.y * 0.5), exact::round(d.z * 0.5)};
    mesh_.positions[split.v] = split.merged + half;
    mesh_.positions[split.w] = split.merged - half;
  }

  Vec3i term(const Ring& ring, const Cut& cut) const {
    if (frame_.placement == Placement::kMidpoint) return midpoint_term(frame_.parity);
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

  bool place(std::size_t s) {
    Split& split = splits_[s];
    const SplitSurroundings around = split_surroundings(mesh_, splits_, s);
    const Vec3i d = displacements_.code(coder_, around, Coder::kEncodes ? told_[s].first : Vec3i{},
                                        split.error);
    const SplitPair pair = unmerge(cell_of(split.merged, frame_.shift), d, split.term);
    if (!in_coordinate_bound(pair.v1) || !in_coordinate_bound(pair.v2)) return false;
    const Vec3i v = middle_of(pair.v1, frame_.shift), w = middle_of(pair.v2, frame_.shift);
    if (!in_coordinate_bound(v) || !in_coordinate_bound(w)) return false;
    mesh_.positions[split.v] = v;
    mesh_.positions[split.w] = w;
    return mesh_.colours.empty() || place_colour(s);
  }

  bool place_colour(std::size_t s) {
    const Split& split = splits_[s];
    const Vec3i told = Coder::kEncodes ? told_[s].second : Vec3i{};
    const Vec3i d = colours_.code(coder_, colour_difference(mesh_, split), told);
    const SplitPair pair = unmerge(split.merged_colour, d, Vec3i{});
    if (!in_coordinate_bound(pair.v1) || !in_coordinate_bound(pair.v2)) return false;
    mesh_.colours[split.v] = pair.v1;
    mesh_.colours[split.w] = pair.v2;
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
  std::vector<Split> splits_;
  std::vector<std::pair<Vec3i, Vec3i>> told_;  // encoder: D of position and of colour
};

}  // namespace vitrine
