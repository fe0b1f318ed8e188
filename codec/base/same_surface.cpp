// SPDX-License-Identifier: Apache-2.0
#include "codec/base/same_surface.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "codec/mesh/connectivity.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

// Matches the vertices of two meshes, component by component. A component is matched by a flood
// fill that starts at one pair of corners. Virtual vertices close both meshes, so that boundary
// loops are compared as well.
class VertexMatcher {
 public:
  VertexMatcher(const BaseMesh& a, const BaseMesh& b, const Connectivity& in_a,
                const Connectivity& in_b)
      : a_(a), b_(b), in_a_(in_a), in_b_(in_b) {
    vertex_.assign(b.positions.size(), kNone);
    is_used_.assign(a.positions.size(), false);
    by_position_.reserve(3 * a.faces.size());
    for (Corner c = 0; c < 3 * a.faces.size(); ++c)
      by_position_.push_back(c);
    std::sort(by_position_.begin(), by_position_.end(), [&](Corner x, Corner y) {
      return std::tuple(a.positions[in_a.vertex(x)], x) <
             std::tuple(a.positions[in_a.vertex(y)], y);
    });
  }

  // Matches the component of b that contains the corner `seed` with a component of a. Returns false
  // if no component of a matches.
  bool match_component(Corner seed) {
    const Vec3i& p = b_.positions[in_b_.vertex(seed)];
    auto candidate = std::lower_bound(
        by_position_.begin(), by_position_.end(), p,
        [&](Corner c, const Vec3i& at) { return a_.positions[in_a_.vertex(c)] < at; });
    for (; candidate != by_position_.end() && a_.positions[in_a_.vertex(*candidate)] == p;
         ++candidate) {
      if (flood(*candidate, seed)) return true;
    }
    return false;
  }

  bool is_matched(VertexId v) const { return vertex_[v] != kNone; }
  std::vector<std::uint32_t> take() { return std::move(vertex_); }

 private:
  bool pair_up(VertexId va, VertexId vb) {
    if (is_virtual(va) || is_virtual(vb)) return is_virtual(va) && is_virtual(vb);
    if (vertex_[vb] != kNone || is_used_[va]) return vertex_[vb] == va;
    if (a_.positions[va] != b_.positions[vb]) return false;
    for (std::size_t i = 0; i < a_.attributes.size(); ++i) {
      if (a_.attributes[i].values[va] != b_.attributes[i].values[vb]) return false;
    }
    vertex_[vb] = va;
    is_used_[va] = true;
    trail_.push_back(vb);
    return true;
  }

  bool flood(Corner seed_a, Corner seed_b) {
    trail_.clear();
    std::vector<bool> seen(in_b_.face_count(), false);
    std::vector<std::pair<Corner, Corner>> open = {{seed_a, seed_b}};
    while (!open.empty()) {
      auto [ca, cb] = open.back();
      open.pop_back();
      if (seen[cb / 3]) continue;
      seen[cb / 3] = true;
      for (int k = 0; k < 3; ++k, ca = next(ca), cb = next(cb)) {
        if (!pair_up(in_a_.vertex(ca), in_b_.vertex(cb))) return undo();
        open.emplace_back(in_a_.opposite(ca), in_b_.opposite(cb));
      }
    }
    return true;
  }

  bool undo() {
    for (VertexId v : trail_) {
      is_used_[vertex_[v]] = false;
      vertex_[v] = kNone;
    }
    return false;
  }

  const BaseMesh& a_;
  const BaseMesh& b_;
  const Connectivity& in_a_;
  const Connectivity& in_b_;
  std::vector<std::uint32_t> vertex_;  // for each vertex of b, the matching vertex of a
  std::vector<bool> is_used_;          // for each vertex of a, whether a vertex of b matches it
  std::vector<VertexId> trail_;
  std::vector<Corner> by_position_;
};

}  // namespace

Expected<std::vector<std::uint32_t>> correspond(const BaseMesh& a, const BaseMesh& b) {
  const auto different = [] {
    return fail(ErrorCode::kBadInput,
                "Draco does not keep the base mesh as it is; please report this mesh");
  };
  if (a.positions.size() != b.positions.size() || a.faces.size() != b.faces.size() ||
      semantics_of(a.attributes) != semantics_of(b.attributes)) {
    return different();
  }
  const auto in_a = Connectivity::close(static_cast<std::uint32_t>(a.positions.size()), a.faces);
  const auto in_b = Connectivity::close(static_cast<std::uint32_t>(b.positions.size()), b.faces);
  if (!in_a || !in_b) return different();
  VertexMatcher matcher(a, b, *in_a, *in_b);
  for (Corner c = 0; c < 3 * b.faces.size(); c += 3) {
    if (!matcher.is_matched(in_b->vertex(c)) && !matcher.match_component(c)) return different();
  }
  return matcher.take();
}

}  // namespace vitrine::inline codec
