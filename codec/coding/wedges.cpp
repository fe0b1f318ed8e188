// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/wedges.h"

#include <algorithm>

#include "codec/format/manifest.h"

namespace vitrine::inline codec {
namespace {

bool is_in_wedge_bound(const Vec2i& p) {
  constexpr auto kMost = static_cast<std::int32_t>(kMaxAtlasSide);
  return p.x >= 0 && p.y >= 0 && p.x <= kMost && p.y <= kMost;
}

bool holds(const std::vector<WedgeId>& list, WedgeId w) {
  return std::find(list.begin(), list.end(), w) != list.end();
}

}  // namespace

Expected<Wedges> Wedges::from_base(const BaseAtlas& atlas, const Connectivity& mesh) {
  Wedges out;
  const auto count = static_cast<std::uint32_t>(atlas.coordinates.size());
  for (const Vec2i& at : atlas.coordinates) {
    if (!is_in_wedge_bound(at)) {
      return fail(ErrorCode::kBadInput, "a texture coordinate is outside the picture");
    }
    out.wedge_.push_back({at, kNoWedge});
  }
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const WedgeId w = mesh.is_real(f) && f < atlas.wedges.size() ? atlas.wedges[f][k] : kNoWedge;
      out.of_corner_.push_back(w);
      if (!mesh.is_real(f)) continue;
      if (w >= count) return fail(ErrorCode::kBadInput, "a corner has no texture coordinates");
      VertexId& vertex = out.wedge_[w].vertex;
      if (vertex == kNoWedge) vertex = mesh.vertex(3 * f + k);
      if (vertex != mesh.vertex(3 * f + k)) {
        return fail(ErrorCode::kBadInput, "two vertices share texture coordinates");
      }
    }
  }
  for (std::uint32_t w = 0; w < count; ++w) {
    if (out.wedge_[w].vertex == kNoWedge) {
      return fail(ErrorCode::kBadInput, "there are texture coordinates that no corner uses");
    }
  }
  out.begin_chunk();
  return out;
}

std::span<const WedgeId> Wedges::at(const Connectivity& mesh, VertexId v) {
  at_.clear();
  const Corner first = mesh.corner_at(v);
  Corner c = first;
  do {
    const WedgeId w = of_corner_[c];
    if (w != kNoWedge && (at_.empty() || (at_.back() != w && !holds(at_, w)))) at_.push_back(w);
    c = mesh.swing(c);
  } while (c != first);
  return at_;
}

void Wedges::begin_chunk() {
  steps_.clear();
  saved_.clear();
  parents_.clear();
  first_of_chunk_ = size();
}

Wedges::Choice Wedges::default_choice(const Sides& first, const Sides& second) {
  const auto side = [](const Sides& sides) -> std::size_t { return sides[0].is_real() ? 0 : 1; };
  const auto is_open = [](const Sides& sides) {
    return sides[0].is_real() && sides[1].is_real() && sides[0] != sides[1];
  };
  return {side(first), side(second), is_open(first) || is_open(second)};
}

// Tries all combinations of sides that the two new faces can join. Returns the combination with the
// shortest seams. Among equally short combinations, prefers the sides of v.
Wedges::Choice Wedges::shortest_seams(const Sides& first, const Sides& second,
                                      const SplitEdgeLengths& lengths) {
  const auto can_join = [](const Sides& sides, std::size_t side) {
    return sides[side].is_real() || !sides[1 - side].is_real();
  };
  // Returns the length of the seam that remains if the new face at this cut edge joins `side`.
  const auto seam = [](const Sides& sides, std::size_t side, double of_v, double of_w) {
    if (sides[1 - side] == sides[side] || !sides[1 - side].is_real()) return 0.0;
    return side == 0 ? of_w : of_v;
  };
  Choice best{.is_open = true};
  double least = -1;
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t b = 0; b < 2; ++b) {
      if (!can_join(first, a) || !can_join(second, b)) continue;
      const bool are_real = first[a].is_real() && second[b].is_real();
      const bool parts = are_real && first[a].centre != second[b].centre;
      const double total = seam(first, a, lengths.v_qi, lengths.w_qi) +
                           seam(second, b, lengths.v_qj, lengths.w_qj) +
                           (parts ? lengths.v_w : 0.0);
      if (least < 0 || total < least) least = total, best = {a, b, true};
    }
  }
  return best;
}

void Wedges::save(std::span<const Corner> ring) {
  steps_.push_back({static_cast<std::uint32_t>(saved_.size()), size()});
  const std::size_t begin = saved_.size();
  for (const Corner c : ring) {
    const WedgeId w = of_corner_[c];
    const auto is_same = [w](const Saved& s) { return s.wedge == w; };
    if (w == kNoWedge) continue;
    if (std::any_of(saved_.begin() + static_cast<std::ptrdiff_t>(begin), saved_.end(), is_same)) {
      continue;
    }
    saved_.push_back({w, wedge_[w].at});
  }
}

void Wedges::divide(VertexId w, std::span<const Corner> ring, std::uint32_t i, std::uint32_t j,
                    const std::array<Side, 2>& joined) {
  save(ring);
  const std::size_t n = ring.size();
  kept_.clear();
  for (std::size_t k = j; k % n != i; ++k)
    kept_.push_back(of_corner_[ring[k % n]]);
  kept_.push_back(joined[0].centre);
  kept_.push_back(joined[1].centre);
  const WedgeId first_new = size();
  // Returns the part of the wedge `whole` that w gets. It is a new wedge if v also keeps a part.
  const auto part_at_w = [&](WedgeId whole) {
    if (whole == kNoWedge) return kNoWedge;
    if (!holds(kept_, whole)) {
      wedge_[whole].vertex = w;
      return whole;
    }
    for (WedgeId part = first_new; part < size(); ++part) {
      if (parents_[part - first_of_chunk_] == whole) return part;
    }
    wedge_.push_back({wedge_[whole].at, w});
    parents_.push_back(whole);
    return size() - 1;
  };
  for (std::size_t k = i; k % n != j; ++k)
    of_corner_[ring[k % n]] = part_at_w(of_corner_[ring[k % n]]);
  const auto [first, second] = joined;
  for (const WedgeId part : {first.centre, first.ring, part_at_w(first.centre), second.centre,
                             part_at_w(second.centre), second.ring}) {
    of_corner_.push_back(part);
  }
}

void Wedges::undo(const Connectivity& mesh, VertexId v, VertexId w) {
  const Step step = steps_.back();
  const Corner first = mesh.corner_at(w);
  Corner c = first;
  do {
    const WedgeId part = of_corner_[c];
    if (part != kNoWedge && part >= step.first_new) {
      of_corner_[c] = parents_[part - first_of_chunk_];
    } else if (part != kNoWedge) {
      wedge_[part].vertex = v;
    }
    c = mesh.swing(c);
  } while (c != first);
  of_corner_.resize(of_corner_.size() - 6, kNoWedge);
  wedge_.resize(step.first_new, {});
  parents_.resize(step.first_new - first_of_chunk_);
  for (std::size_t s = step.first_saved; s < saved_.size(); ++s)
    wedge_[saved_[s].wedge].at = saved_[s].at;
  saved_.resize(step.first_saved);
  steps_.pop_back();
}

}  // namespace vitrine::inline codec
