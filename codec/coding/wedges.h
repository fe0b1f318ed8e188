// SPDX-License-Identifier: Apache-2.0
// The texture coordinates of a mesh during refinement.
//
// A wedge is a run of face corners at one vertex that share their texture coordinates. An edge is a
// seam if its two faces have different wedges at one of its ends. A vertex split divides wedges
// between its two vertices; no data is coded for that (codec/FORMAT.md section 8).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/segments.h"
#include "codec/core/vec2.h"
#include "codec/format/base_mesh.h"
#include "codec/mesh/connectivity.h"

namespace vitrine::inline codec {

using WedgeId = std::uint32_t;
// The wedge of corners whose faces close boundary loops.
inline constexpr WedgeId kNoWedge = 0xFFFF'FFFFu;

struct Wedge {
  Vec2i at;             // integer texture coordinates; a picture is TextureInfo::side units wide
  VertexId vertex = 0;  // the vertex at which all corners of the wedge lie
};

// The lengths of the five edges that may be seams after v was split into v and w. The split begins
// at the ring vertex q_i and ends at q_j.
struct SplitEdgeLengths {
  double v_qi = 0, w_qi = 0, v_qj = 0, w_qj = 0, v_w = 0;
};

class Wedges {
 public:
  Wedges() = default;
  // Returns the wedges of a base mesh. `mesh` is the connectivity of the base mesh. Its first faces
  // are the faces of the base mesh. Fails (kBadInput) if a wedge is out of range or belongs to
  // several vertices, or if a coordinate is out of bounds.
  static Expected<Wedges> from_base(const BaseAtlas& atlas, const Connectivity& mesh);

  bool empty() const { return wedge_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(wedge_.size()); }
  WedgeId of(Corner c) const { return of_corner_[c]; }
  const Wedge& operator[](WedgeId w) const { return wedge_[w]; }
  void move(WedgeId w, const Vec2i& to) { wedge_[w].at = to; }

  // Returns the different wedges at v, in the order of the ring from corner_at(v). The result is
  // valid until the next call.
  std::span<const WedgeId> at(const Connectivity& mesh, VertexId v);

  // Discards the data that undo() needs. Call this before the first split of a chunk.
  void begin_chunk();

  // Updates the wedges after Connectivity::split(v, ring, i, j), which created the vertex w and the
  // last two faces. `lengths()` returns the SplitEdgeLengths; it is called only if the split
  // touches a seam. Coordinates do not change: both parts of a divided wedge get its coordinates.
  template <class Lengths>
  void split(VertexId w, std::span<const Corner> ring, std::uint32_t i, std::uint32_t j,
             const Lengths& lengths) {
    const Sides first = {side(ring[before(ring, i)], 2), side(ring[i], 1)};
    const Sides second = {side(ring[j], 1), side(ring[before(ring, j)], 2)};
    Choice choice = default_choice(first, second);
    if (choice.is_open) choice = shortest_seams(first, second, lengths());
    divide(w, ring, i, j, {first[choice.first], second[choice.second]});
  }

  // Returns the wedge from which the newest split made `part`. Returns `part` itself if it is older
  // than this split.
  WedgeId whole(WedgeId part) const {
    return part < steps_.back().first_new ? part : parents_[part - first_of_chunk_];
  }

  // Returns the wedge from which a split of the newest chunk made `part`. Returns `part` itself if
  // it is older than this chunk.
  WedgeId parent(WedgeId part) const {
    return part < first_of_chunk_ ? part : parents_[part - first_of_chunk_];
  }

  // Undoes the newest split that is not undone yet, which split v into v and w. Call this before
  // Connectivity::unsplit().
  void undo(const Connectivity& mesh, VertexId v, VertexId w);

 private:
  // The wedges of a face at the split vertex and at a ring vertex. Both are kNoWedge for a face
  // that closes a boundary loop.
  struct Side {
    WedgeId centre = kNoWedge, ring = kNoWedge;
    bool operator==(const Side&) const = default;
    bool is_real() const { return centre != kNoWedge; }
  };
  // The faces on both sides of a cut edge: first the face that stays at v, then the face that goes
  // to w.
  using Sides = std::array<Side, 2>;
  // Which side each of the two new faces joins: 0 for the face at v, 1 for the face at w.
  struct Choice {
    std::size_t first = 0, second = 0;
    bool is_open = false;  // whether there are several choices; if so, seam lengths decide
  };
  struct Saved {
    WedgeId wedge;
    Vec2i at;
  };
  // A split, for undo(): the indices of its first saved coordinates and of the first wedge that it
  // created.
  struct Step {
    std::uint32_t first_saved;
    WedgeId first_new;
  };

  static std::size_t before(std::span<const Corner> ring, std::uint32_t k) {
    return (k == 0 ? ring.size() : k) - 1;
  }
  // Returns the wedges at two corners of a face: at corner c, and at the corner `turns` steps after
  // c.
  Side side(Corner c, int turns) const {
    return {of_corner_[c], of_corner_[turns == 1 ? next(c) : prev(c)]};
  }
  static Choice default_choice(const Sides& first, const Sides& second);
  static Choice shortest_seams(const Sides& first, const Sides& second,
                               const SplitEdgeLengths& lengths);
  void divide(VertexId w, std::span<const Corner> ring, std::uint32_t i, std::uint32_t j,
              const std::array<Side, 2>& joined);
  void save(std::span<const Corner> ring);

  Segments<WedgeId> of_corner_;
  Segments<Wedge> wedge_;
  std::vector<WedgeId> at_;       // result of at()
  std::vector<WedgeId> kept_;     // used by divide(): the wedges that v keeps
  std::vector<Step> steps_;       // one for each split of the chunk
  std::vector<Saved> saved_;      // saved coordinates of all steps
  std::vector<WedgeId> parents_;  // for each new wedge of the chunk, the wedge it came from
  WedgeId first_of_chunk_ = 0;    // the first new wedge of the chunk
};

}  // namespace vitrine::inline codec
