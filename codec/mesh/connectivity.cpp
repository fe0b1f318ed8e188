// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/connectivity.h"

#include <algorithm>
#include <array>
#include <utility>

#include "codec/core/fill_in.h"

namespace vitrine::inline codec {
namespace {

Unexpected bad(const char* what, std::initializer_list<std::uint64_t> where) {
  return fail(ErrorCode::kBadInput, fill_in(what, where));
}

Unexpected has_more_fans(VertexId v, Corner c) {
  return bad("vertex {} has more than one fan at face {}", {v, c / 3});
}

Expected<void> check_faces(std::uint32_t vertex_count, std::span<const Triangle> faces) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    if (std::max({a, b, c}) >= vertex_count) {
      return bad("vertex index out of range at face {}", {f});
    }
    if (a == b || b == c || c == a) return bad("repeated vertex at face {}", {f});
  }
  return {};
}

}  // namespace

// The directed edges of all faces, sorted by start vertex, then end vertex, then corner. The table
// serves to find the opposite half-edge of each edge. The edges that leave vertex v have the
// indices from start[v] to start[v + 1] - 1.
struct Connectivity::EdgeTable {
  struct DirectedEdge {
    VertexId to;
    Corner corner;  // the corner opposite to this edge in its face
  };

  std::vector<DirectedEdge> edges;
  std::vector<std::uint32_t> start;

  EdgeTable(std::uint32_t vertex_count, std::span<const Triangle> faces);

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(start.size() - 1); }

  std::span<const DirectedEdge> leaving(VertexId v) const {
    return std::span(edges).subspan(start[v], start[v + 1] - start[v]);
  }

  // Returns the edge from `from` to `to`, or null if there is none.
  const DirectedEdge* find(VertexId from, VertexId to) const {
    const auto candidates = leaving(from);
    const auto found = std::lower_bound(
        candidates.begin(), candidates.end(), to,
        [](const DirectedEdge& candidate, VertexId end) { return candidate.to < end; });
    return found != candidates.end() && found->to == to ? &*found : nullptr;
  }

  Expected<void> check_distinct() const;
};

// Sorts the edges by end vertex and then by start vertex, with two counting sorts. Both sorts use
// the same table of counts, because each vertex has as many incoming as outgoing edges.
Connectivity::EdgeTable::EdgeTable(std::uint32_t vertex_count, std::span<const Triangle> faces)
    : edges(faces.size() * 3), start(std::size_t{vertex_count} + 1, 0) {
  const auto corners = static_cast<Corner>(faces.size() * 3);
  const auto start_of = [&](Corner c) { return faces[c / 3][next(c) % 3]; };
  const auto end_of = [&](Corner c) { return faces[c / 3][prev(c) % 3]; };
  for (Corner c = 0; c < corners; ++c)
    ++start[start_of(c)];
  std::uint32_t sum = 0;
  for (std::uint32_t& s : start)
    sum += std::exchange(s, sum);
  std::vector<std::uint32_t> free(start);
  std::vector<Corner> by_end(corners);
  for (Corner c = 0; c < corners; ++c)
    by_end[free[end_of(c)]++] = c;
  free = start;
  for (const Corner c : by_end)
    edges[free[start_of(c)]++] = {end_of(c), c};
}

Expected<void> Connectivity::EdgeTable::check_distinct() const {
  for (VertexId from = 0; from < vertex_count(); ++from) {
    const auto leaving_from = leaving(from);
    for (std::size_t i = 1; i < leaving_from.size(); ++i) {
      if (leaving_from[i].to == leaving_from[i - 1].to) {
        return bad("non-manifold or inconsistently oriented edge at face {}",
                   {leaving_from[i].corner / 3});
      }
    }
  }
  return {};
}

Expected<Connectivity> Connectivity::close(std::uint32_t vertex_count,
                                           std::span<const Triangle> faces) {
  if (auto ok = check_faces(vertex_count, faces); !ok) return tl::unexpected(ok.error());
  Connectivity mesh;
  mesh.corner_at_.resize(vertex_count, kNoCorner);
  for (const auto& [a, b, c] : faces)
    mesh.add_face(a, b, c);

  const EdgeTable table(vertex_count, faces);
  if (auto ok = table.check_distinct(); !ok) return tl::unexpected(ok.error());
  const auto border = mesh.glue_twins(table);
  if (!border) return tl::unexpected(border.error());
  if (auto ok = mesh.close_loops(*border); !ok) return tl::unexpected(ok.error());
  if (auto ok = mesh.anchor_fans(); !ok) return tl::unexpected(ok.error());
  return mesh;
}

Expected<std::vector<Corner>> Connectivity::glue_twins(const EdgeTable& table) {
  std::vector<Corner> border(vertex_count(), kNoCorner);
  for (VertexId from = 0; from < border.size(); ++from) {
    for (const EdgeTable::DirectedEdge& e : table.leaving(from)) {
      if (const EdgeTable::DirectedEdge* twin = table.find(e.to, from)) {
        step_[prev(e.corner)].swing = next(twin->corner);
        continue;
      }
      if (border[from] != kNoCorner) return has_more_fans(from, e.corner);
      border[from] = e.corner;
    }
  }
  return border;
}

// A border edge runs from a to b. The virtual face at this edge is therefore (b, a, virtual
// vertex).
Expected<void> Connectivity::close_loops(std::span<const Corner> border) {
  std::vector<std::uint8_t> is_closed(border.size(), false);
  for (VertexId start = 0; start < border.size(); ++start) {
    if (border[start] == kNoCorner || is_closed[start]) continue;
    const VertexId loop = kVirtualBit + static_cast<VertexId>(loop_length_.size());
    std::uint32_t length = 0;
    const Corner first = static_cast<Corner>(step_.size());
    for (VertexId a = start; !is_closed[a]; ++length) {
      is_closed[a] = true;
      const Corner c = border[a];
      const VertexId b = vertex(prev(c));
      if (border[b] == kNoCorner) return bad("boundary is not a closed loop at face {}", {c / 3});
      const Corner base = static_cast<Corner>(step_.size());
      add_face(b, a, loop);
      glue(base + 2, c);
      // This face shares the edge (virtual vertex, a) with the previous face. The corners opposite
      // to the edge are the previous face's second corner and this face's first corner.
      if (length > 0) glue(base - 3 + 1, base);
      a = b;
    }
    glue(static_cast<Corner>(step_.size()) - 3 + 1, first);
    loop_length_.push_back(length);
  }
  return {};
}

Expected<void> Connectivity::anchor_fans() {
  std::vector<std::uint32_t> corners(vertex_count(), 0);
  for (Corner c = 0; c < step_.size(); ++c) {
    const VertexId v = vertex(c);
    if (is_virtual(v)) continue;
    ++corners[v];
    if (corner_at_[v] == kNoCorner) corner_at_[v] = c;
  }
  for (VertexId v = 0; v < corners.size(); ++v) {
    const Corner first = corner_at_[v];
    if (first == kNoCorner) return bad("vertex {} belongs to no face", {v});
    std::uint32_t fan = 0;
    Corner c = first;
    do {
      ++fan;
      c = swing(c);
    } while (c != first && fan <= corners[v]);
    if (fan != corners[v]) return has_more_fans(v, first);
  }
  return {};
}

std::uint32_t Connectivity::ring(VertexId v, std::span<Corner> corners) const {
  const Corner first = corner_at_[v];
  std::uint32_t valence = 0;
  Corner c = first;
  do {
    if (valence == corners.size()) return 0;
    corners[valence++] = c;
    c = swing(c);
  } while (c != first);
  return valence;
}

void Connectivity::add_face(VertexId a, VertexId b, VertexId c) {
  for (const VertexId to : {b, c, a})
    step_.push_back({.to = to});
}

void Connectivity::add_valence(VertexId v, int delta) {
  if (is_virtual(v)) loop_length_[v & ~kVirtualBit] += static_cast<std::uint32_t>(delta);
}

void Connectivity::anchor(VertexId v, Corner c) {
  if (!is_virtual(v)) corner_at_[v] = c;
}

VertexId Connectivity::split(VertexId v, std::span<const Corner> corners, std::uint32_t i,
                             std::uint32_t j) {
  const std::uint32_t n = static_cast<std::uint32_t>(corners.size());
  const auto before = [n](std::uint32_t k) { return k == 0 ? n - 1 : k - 1; };
  const Corner before_i = corners[before(i)], at_i = corners[i];
  const Corner before_j = corners[before(j)], at_j = corners[j];
  const VertexId qi = neighbour(at_i), qj = neighbour(at_j);
  const VertexId w = vertex_count();

  corner_at_.push_back(at_i);
  for (std::uint32_t k = i; k != j; k = k + 1 == n ? 0 : k + 1)
    set_vertex(corners[k], w);
  // The `swing` values below are those that glue() would set for the five pairs of opposite
  // corners.
  const Corner a = static_cast<Corner>(step_.size()), b = a + 3;
  step_.push_back({.to = qi, .swing = b});
  step_.push_back({.to = w, .swing = prev(before_i)});
  step_.push_back({.to = v, .swing = at_i});
  step_.push_back({.to = w, .swing = at_j});
  step_.push_back({.to = qj, .swing = a + 2});
  step_.push_back({.to = v, .swing = prev(before_j)});
  step_[before_i].swing = a;
  step_[next(at_i)].swing = a + 1;
  step_[before_j].swing = b + 1;
  step_[next(at_j)].swing = b + 2;
  corner_at_[v] = at_j;
  add_valence(qi, 1);
  add_valence(qj, 1);
  return w;
}

void Connectivity::collapse(Corner c) {
  // Face B is (v1, v2, apex12). Face A, across the edge (v1, v2), is (v2, v1, apex21).
  const Corner b1 = c, b2 = next(c), b3 = prev(c);
  const Corner a3 = opposite(b3), a2 = next(a3), a1 = prev(a3);  // a1 is at v1, a2 at v2
  const VertexId v1 = vertex(b1), v2 = vertex(b2), apex12 = vertex(b3), apex21 = vertex(a3);
  // Assigns all corners of v2 to v1.
  Corner k = b2;
  do {
    set_vertex(k, v1);
    k = swing(k);
  } while (k != b2);
  const Corner over_b1 = opposite(b1), over_b2 = opposite(b2);
  const Corner over_a1 = opposite(a1), over_a2 = opposite(a2);
  glue(over_b1, over_b2);
  glue(over_a1, over_a2);
  anchor(v1, next(over_b2));
  anchor(apex12, prev(over_b2));
  anchor(apex21, prev(over_a1));
  corner_at_[v2] = kNoCorner;
  for (Corner dead : {b1, b2, b3, a1, a2, a3})
    set_vertex(dead, kNoCorner);
  add_valence(apex12, -1);
  add_valence(apex21, -1);
}

void Connectivity::unsplit(VertexId v) {
  const Corner b = static_cast<Corner>(step_.size()) - 3;  // corner of v in the face (v, w, q_j)
  if (vertex(b) != v) return;
  collapse(b);
  step_.resize(step_.size() - 6, {});
  corner_at_.pop_back();
}

void Connectivity::append(Connectivity part) {
  if (face_count() == 0) {
    *this = std::move(part);
    return;
  }
  const VertexId first = vertex_count(), first_loop = loop_count();
  const auto shift = static_cast<Corner>(step_.size());
  for (Corner c = 0; c < part.step_.size(); ++c) {
    const auto& [to, swing] = part.step_[c];
    step_.push_back({to + (is_virtual(to) ? first_loop : first), swing + shift});
  }
  for (VertexId v = 0; v < part.vertex_count(); ++v)
    corner_at_.push_back(part.corner_at_[v] + shift);
  loop_length_.insert(loop_length_.end(), part.loop_length_.begin(), part.loop_length_.end());
}

void Connectivity::drop(std::uint32_t vertices, std::uint32_t faces, std::uint32_t loops) {
  step_.resize(step_.size() - 3 * std::size_t{faces}, {});
  corner_at_.resize(corner_at_.size() - vertices, kNoCorner);
  loop_length_.resize(loop_length_.size() - loops);
}

void Connectivity::erase(VertexId v) {
  const Corner first = corner_at_[v];
  Corner c = first;
  do {
    const Corner corner = c;
    c = swing(c);
    for (const Corner k : {corner, next(corner), prev(corner)}) {
      if (vertex(k) == kNoCorner) break;  // the face was removed with another vertex
      add_valence(vertex(k), -1);
      set_vertex(k, kNoCorner);
    }
  } while (c != first);
  corner_at_[v] = kNoCorner;
}

}  // namespace vitrine::inline codec
