// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/connectivity.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace vitrine {
namespace {

// Directed edges sorted by (from, to), to find the twin of each.
struct DirectedEdge {
  std::uint64_t key;
  Corner corner;  // opposite to the edge
};

constexpr std::uint64_t edge_key(VertexId from, VertexId to) {
  return std::uint64_t{from} << 32 | to;
}

std::string at_face(Corner c) {
  return " at face " + std::to_string(c / 3);
}

Unexpected bad(std::string what) {
  return fail(ErrorCode::kBadInput, std::move(what));
}

Expected<void> check_faces(std::uint32_t vertex_count, std::span<const Triangle> faces) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    if (std::max({a, b, c}) >= vertex_count) {
      return bad("vertex index out of range at face " + std::to_string(f));
    }
    if (a == b || b == c || c == a) return bad("repeated vertex at face " + std::to_string(f));
  }
  return {};
}

// Edges sorted by key, then corner; those that leave v are [start[v], start[v + 1]).
struct EdgeTable {
  std::vector<DirectedEdge> edges;
  std::vector<std::uint32_t> start;

  std::span<const DirectedEdge> leaving(VertexId v) const {
    return std::span(edges).subspan(start[v], start[v + 1] - start[v]);
  }
};

// A counting sort by the vertex left, and then few edges at each vertex.
EdgeTable edge_table(std::uint32_t vertex_count, std::span<const Triangle> faces) {
  EdgeTable table{.edges = std::vector<DirectedEdge>(faces.size() * 3),
                  .start = std::vector<std::uint32_t>(std::size_t{vertex_count} + 1, 0)};
  for (const Triangle& f : faces) {
    for (VertexId v : f)
      ++table.start[v];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& s : table.start)
    sum += std::exchange(s, sum);
  std::vector<std::uint32_t> free(table.start);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexId from = faces[f][(k + 1) % 3], to = faces[f][(k + 2) % 3];
      table.edges[free[from]++] = {edge_key(from, to), static_cast<Corner>(3 * f + k)};
    }
  }
  for (VertexId v = 0; v < vertex_count; ++v) {
    std::sort(table.edges.begin() + table.start[v], table.edges.begin() + table.start[v + 1],
              [](const DirectedEdge& a, const DirectedEdge& b) {
                return a.key != b.key ? a.key < b.key : a.corner < b.corner;
              });
  }
  return table;
}

}  // namespace

Expected<Connectivity> Connectivity::close(std::uint32_t vertex_count,
                                           std::span<const Triangle> faces) {
  if (auto ok = check_faces(vertex_count, faces); !ok) return tl::unexpected(ok.error());
  Connectivity mesh;
  mesh.corner_at_.resize(vertex_count, kNoCorner);
  for (const auto& [a, b, c] : faces)
    mesh.add_face(a, b, c);

  const EdgeTable table = edge_table(vertex_count, faces);
  const std::vector<DirectedEdge>& edges = table.edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i + 1 < edges.size() && edges[i].key == edges[i + 1].key) {
      return bad("non-manifold or inconsistently oriented edge" + at_face(edges[i + 1].corner));
    }
  }
  // border[v]: the corner opposite the border edge that leaves v (the real face's direction).
  std::vector<Corner> border(vertex_count, kNoCorner);
  for (const DirectedEdge& e : edges) {
    const std::uint64_t twin = e.key >> 32 | e.key << 32;
    const auto candidates = table.leaving(static_cast<VertexId>(twin >> 32));
    const auto it = std::lower_bound(
        candidates.begin(), candidates.end(), twin,
        [](const DirectedEdge& other, std::uint64_t key) { return other.key < key; });
    if (it != candidates.end() && it->key == twin) {
      mesh.step_[prev(e.corner)].swing = next(it->corner);
      continue;
    }
    const VertexId from = static_cast<VertexId>(e.key >> 32);
    if (border[from] != kNoCorner) {
      return bad("vertex " + std::to_string(from) + " has more than one fan" + at_face(e.corner));
    }
    border[from] = e.corner;
  }
  // Close each loop, numbered by its smallest vertex: the loop's real edges run a -> b, so the
  // closing faces are (b, a, virtual).
  std::vector<bool> closed(vertex_count, false);
  for (VertexId start = 0; start < vertex_count; ++start) {
    if (border[start] == kNoCorner || closed[start]) continue;
    const VertexId loop = kVirtualBit + static_cast<VertexId>(mesh.loop_length_.size());
    std::uint32_t length = 0;
    const Corner first = static_cast<Corner>(mesh.step_.size());
    for (VertexId a = start; !closed[a]; ++length) {
      closed[a] = true;
      const Corner c = border[a];
      const VertexId b = mesh.vertex(prev(c));
      if (border[b] == kNoCorner) return bad("boundary is not a closed loop" + at_face(c));
      const Corner base = static_cast<Corner>(mesh.step_.size());
      mesh.add_face(b, a, loop);
      mesh.glue(base + 2, c);
      // Edge (virtual, b) of this face is shared with the next one, which leaves from b; the
      // corner opposite to it here is a's, there it is its own b corner.
      if (length > 0) mesh.glue(base - 3 + 1, base);
      a = b;
    }
    mesh.glue(static_cast<Corner>(mesh.step_.size()) - 3 + 1, first);
    mesh.loop_length_.push_back(length);
  }
  std::vector<std::uint32_t> corners(vertex_count, 0);
  for (Corner c = 0; c < mesh.step_.size(); ++c) {
    const VertexId v = mesh.vertex(c);
    if (is_virtual(v)) continue;
    ++corners[v];
    if (mesh.corner_at_[v] == kNoCorner) mesh.corner_at_[v] = c;
  }
  for (VertexId v = 0; v < vertex_count; ++v) {
    const Corner first = mesh.corner_at_[v];
    if (first == kNoCorner) return bad("vertex " + std::to_string(v) + " belongs to no face");
    std::uint32_t fan = 0;
    Corner c = first;
    do {
      ++fan;
      c = mesh.swing(c);
    } while (c != first && fan <= corners[v]);
    if (fan != corners[v]) {
      return bad("vertex " + std::to_string(v) + " has more than one fan" + at_face(first));
    }
  }
  return mesh;
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
  const Corner a = static_cast<Corner>(step_.size()), b = a + 3;
  add_face(v, qi, w);
  add_face(v, w, qj);
  glue(next(before_i), a + 2);
  glue(prev(at_i), a);
  glue(a + 1, b + 2);
  glue(next(before_j), b);
  glue(prev(at_j), b + 1);
  corner_at_[v] = at_j;
  add_valence(qi, 1);
  add_valence(qj, 1);
  return w;
}

void Connectivity::collapse(Corner c) {
  // Face B = (v1, v2, apex12); face A = (v2, v1, apex21) lies across the edge (v1, v2).
  const Corner b1 = c, b2 = next(c), b3 = prev(c);
  const Corner a3 = opposite(b3), a2 = next(a3), a1 = prev(a3);  // a2 at v2, a1 at v1
  const VertexId v1 = vertex(b1), v2 = vertex(b2), apex12 = vertex(b3), apex21 = vertex(a3);
  // Every corner of v2 becomes one of v1.
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
  const Corner b = static_cast<Corner>(step_.size()) - 3;  // (v, w, qj)
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
      if (vertex(k) == kNoCorner) break;  // it went with another of its vertices
      add_valence(vertex(k), -1);
      set_vertex(k, kNoCorner);
    }
  } while (c != first);
  corner_at_[v] = kNoCorner;
}

}  // namespace vitrine
