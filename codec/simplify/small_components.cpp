// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/small_components.h"

#include <algorithm>
#include <span>

#include "codec/format/chunk_frame.h"

namespace vitrine::inline codec {
namespace {

// A component with at most this many vertices may be removed even if edges could still collapse.
constexpr std::size_t kFew = 8;
// A component is hidden by a level's error if its diameter is less than this many times the level's
// rms error.
constexpr double kDiameterPerError = 4;

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

struct CellBox {
  Vec3i low, high;

  explicit CellBox(const Vec3i& p) : low(p), high(p) {}
  void add(const Vec3i& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  double square() const {
    const Vec3 side = to_vec3(high - low);
    return dot(side, side);
  }
};

template <class Visit>
void for_each_corner(const Connectivity& mesh, VertexId v, const Visit& visit) {
  const Corner first = mesh.corner_at(v);
  Corner c = first;
  do {
    visit(c);
    c = mesh.swing(c);
  } while (c != first);
}

// Labels each vertex with the number of its component. Components are numbered in ascending order
// of their smallest vertices. Returns the number of components.
std::uint32_t label_components(const Connectivity& mesh, std::vector<std::uint32_t>& label) {
  label.assign(mesh.vertex_count(), kNone);
  std::uint32_t count = 0;
  std::vector<VertexId> pending;
  for (VertexId start = 0; start < mesh.vertex_count(); ++start) {
    if (label[start] != kNone) continue;
    label[start] = count;
    pending.push_back(start);
    while (!pending.empty()) {
      const VertexId v = pending.back();
      pending.pop_back();
      for_each_corner(mesh, v, [&](Corner c) {
        const VertexId w = mesh.neighbour(c);
        if (is_virtual(w) || label[w] != kNone) return;
        label[w] = count;
        pending.push_back(w);
      });
    }
    ++count;
  }
  return count;
}

std::uint32_t largest_component(const std::vector<Vec3i>& position,
                                const std::vector<std::uint32_t>& label, std::uint32_t count) {
  std::vector<CellBox> boxes;
  for (VertexId v = 0; v < label.size(); ++v) {
    if (label[v] == boxes.size()) boxes.emplace_back(position[v]);
    boxes[label[v]].add(position[v]);
  }
  const auto largest = std::ranges::max_element(boxes, {}, &CellBox::square);
  return count > 0 ? static_cast<std::uint32_t>(largest - boxes.begin()) : kNone;
}

double square_of_box(const Surface& surface, std::span<const VertexId> members) {
  CellBox box(surface.position[members[0]]);
  for (const VertexId v : members)
    box.add(surface.position[v]);
  const double cell = static_cast<double>(1u << surface.shift);
  return box.square() * cell * cell;
}

// Returns the component that consists of the vertices `members`, which must be in ascending order.
Component component_of(const Surface& surface, std::span<const VertexId> members) {
  Component out;
  add_columns(out.mesh.attributes, surface.attributes);
  const auto index = [&](VertexId v) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(members, v) - members.begin());
  };
  for (const VertexId v : members) {
    out.ids.push_back(v);
    out.mesh.positions.push_back(surface.position[v]);
    append_row(out.mesh.attributes, surface.attributes, v);
    for_each_corner(surface.mesh, v, [&](Corner c) {
      const VertexId a = surface.mesh.neighbour(c), b = surface.mesh.vertex(prev(c));
      if (v < a && v < b && !is_virtual(a) && !is_virtual(b))
        out.mesh.faces.push_back({index(v), index(a), index(b)});
    });
  }
  return out;
}

bool is_in_one_region(const Surface& surface, std::span<const VertexId> members) {
  return std::ranges::all_of(
      members, [&](VertexId v) { return surface.region[v] == surface.region[members[0]]; });
}

}  // namespace

SmallComponents::SmallComponents(const Surface& surface) {
  std::vector<std::uint32_t> label;
  const std::uint32_t count = label_components(surface.mesh, label);
  if (count < 2) return;
  const std::uint32_t largest = largest_component(surface.position, label, count);
  std::vector<std::size_t> size(count);
  for (const std::uint32_t l : label)
    size[l] += l != largest ? 1 : 0;
  for (std::size_t sum = 0; const std::size_t s : size)
    ranges_.push_back({.begin = sum, .size = 0}), sum += s;
  members_.resize(ranges_.back().begin + size.back());
  for (VertexId v = 0; v < label.size(); ++v) {
    if (label[v] == largest) continue;
    MemberRange& range = ranges_[label[v]];
    members_[range.begin + range.size++] = v;
  }
  std::erase_if(ranges_, [](const MemberRange& range) { return range.size == 0; });
  vertices_ = members_.size();
}

void SmallComponents::update(const Surface& surface) {
  vertices_ = 0;
  for (MemberRange& range : ranges_) {
    const auto begin = members_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto is_gone = [&](VertexId v) { return surface.mesh.corner_at(v) == kNoCorner; };
    const auto end =
        std::remove_if(begin, begin + static_cast<std::ptrdiff_t>(range.size), is_gone);
    const auto size = static_cast<std::size_t>(end - begin);
    range.has_shrunk = size < range.size;
    range.size = size;
    vertices_ += size;
  }
}

std::vector<Component> SmallComponents::leave(Surface& surface, const Need& need) {
  update(surface);
  struct LeavingCandidate {
    double square;
    MemberRange* range;
  };
  std::vector<LeavingCandidate> candidates;
  for (MemberRange& range : ranges_) {
    const auto members = std::span(members_).subspan(range.begin, range.size);
    const bool is_smallest =
        range.size <= kFew || (!range.has_shrunk && range.size <= kMostInserted);
    if (is_smallest && is_in_one_region(surface, members))
      candidates.push_back({square_of_box(surface, members), &range});
  }
  std::ranges::stable_sort(candidates, {}, &LeavingCandidate::square);

  const double hidden = kDiameterPerError * need.error;
  std::size_t left = surface.live.size();
  std::vector<Component> leaving;
  for (const LeavingCandidate& candidate : candidates) {
    if (left <= need.vertices && candidate.square >= hidden * hidden) break;
    MemberRange& range = *candidate.range;
    Component component =
        component_of(surface, std::span(members_).subspan(range.begin, range.size));
    if (component.mesh.faces.size() > 2 * component.ids.size()) continue;
    for (const VertexId v : component.ids)
      surface.mesh.erase(v);
    left -= range.size;
    vertices_ -= range.size;
    range.size = 0;
    leaving.push_back(std::move(component));
  }
  if (leaving.empty()) return leaving;
  std::erase_if(ranges_, [](const MemberRange& range) { return range.size == 0; });
  std::erase_if(surface.live, [&](VertexId v) { return surface.mesh.corner_at(v) == kNoCorner; });
  return leaving;
}

}  // namespace vitrine::inline codec
