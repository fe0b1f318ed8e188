// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/mesh_state.h"

#include <algorithm>

#include "codec/progressive/colour.h"

namespace vitrine {

Expected<MeshState> MeshState::from_base(const BaseMesh& base, std::uint32_t shift,
                                         std::uint32_t leaves) {
  const auto n = static_cast<std::uint32_t>(base.positions.size());
  auto closed = Connectivity::close(n, base.faces);
  if (!closed) return tl::unexpected(closed.error());
  if (!std::all_of(base.positions.begin(), base.positions.end(), in_coordinate_bound) ||
      !std::all_of(base.colours.begin(), base.colours.end(), in_coordinate_bound)) {
    return fail(ErrorCode::kBadInput, "the base mesh leaves the lattice or the range of colours");
  }
  MeshState mesh{.connectivity = std::move(*closed), .positions = {}};
  mesh.shift = mesh.foreign_shift = shift;
  for (const Vec3i& cell : base.positions)
    mesh.positions.push_back(middle_of(cell, shift));
  if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), in_coordinate_bound))
    return fail(ErrorCode::kBadInput, "the base mesh leaves the lattice");
  mesh.colours = base.colours;
  mesh.region.assign(n, 0);
  mesh.split_level.assign(n, 0);
  mesh.visited_level.assign(n, 0);
  mesh.border.assign(n, 0);
  mesh.valence.assign(n, 0);
  mesh.split_of.assign(n, 0xFFFF'FFFFu);
  mesh.members.resize(leaves);
  mesh.born.assign(leaves, 0);
  mesh.born[0] = n;
  for (VertexId v = 0; v < n; ++v) {
    mesh.birth.push_back(v);
    mesh.members[0].push_back(v);
    mesh.count_valence(v);
  }
  return mesh;
}

void MeshState::reserve(std::size_t vertices) {
  connectivity.reserve(vertices, 2 * vertices);
  positions.reserve(vertices);
  if (!colours.empty()) colours.reserve(vertices);
  region.reserve(vertices);
  birth.reserve(vertices);
  split_level.reserve(vertices);
  visited_level.reserve(vertices);
  border.reserve(vertices);
  valence.reserve(vertices);
  split_of.reserve(vertices);
}

void MeshState::count_valence(VertexId v) {
  const Corner first = connectivity.corner_at(v);
  Corner c = first;
  valence[v] = 0;
  do {
    if (valence[v] < 255) ++valence[v];
    c = connectivity.swing(c);
  } while (c != first);
}

void MeshState::inherit(VertexId v) {
  const std::uint16_t k = region[v];
  const VertexId w = vertex_count();
  positions.push_back(positions[v]);
  if (!colours.empty()) colours.push_back(colours[v]);
  region.push_back(k);
  birth.push_back(std::uint64_t{k} << 32 | born[k]++);
  members[k].push_back(w);
  split_level.push_back(split_level[v]);
  visited_level.push_back(visited_level[v]);
  border.push_back(border[v]);
  valence.push_back(0);
  split_of.push_back(split_of[v]);
}

void MeshState::disinherit() {
  members[region.back()].pop_back();
  --born[birth.back() >> 32];
  positions.pop_back();
  if (!colours.empty()) colours.pop_back();
  region.pop_back();
  birth.pop_back();
  split_level.pop_back();
  visited_level.pop_back();
  border.pop_back();
  valence.pop_back();
  split_of.pop_back();
}

std::uint32_t MeshState::real_face_count() const {
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < connectivity.face_count(); ++f)
    count += connectivity.is_real(f) ? 1 : 0;
  return count;
}

std::vector<Triangle> MeshState::real_faces() const {
  std::vector<Triangle> faces;
  faces.reserve(real_face_count());
  for (std::uint32_t f = 0; f < connectivity.face_count(); ++f) {
    if (!connectivity.is_real(f)) continue;
    faces.push_back({connectivity.vertex(3 * f), connectivity.vertex(3 * f + 1),
                     connectivity.vertex(3 * f + 2)});
  }
  return faces;
}

std::vector<Colour> MeshState::display_colours() const {
  std::vector<Colour> out;
  out.reserve(colours.size());
  for (const Vec3i& c : colours)
    out.push_back(from_ycocg(c));
  return out;
}

void MeshState::mark_border(VertexId v) {
  const Corner first = connectivity.corner_at(v);
  border[v] = 0;
  Corner c = first;
  do {
    const VertexId q = connectivity.vertex(next(c));
    if (!is_virtual(q) && region[q] != region[v]) border[v] = 1;
    c = connectivity.swing(c);
  } while (c != first);
}

}  // namespace vitrine
