// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/mesh_state.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vitrine::inline codec {

Expected<MeshState> MeshState::from_base(const BaseMesh& base, std::uint32_t shift,
                                         std::uint32_t leaves) {
  MeshState mesh;
  mesh.shift = mesh.foreign_shift = shift;
  mesh.members.resize(leaves);
  mesh.ordinals.assign(leaves, 0);
  add_columns(mesh.attributes, base.attributes);
  if (auto ok = mesh.add(base, 0, 0); !ok) return tl::unexpected(ok.error());
  if (base.atlas.empty()) return mesh;
  auto wedges = Wedges::from_base(base.atlas, mesh.connectivity);
  if (!wedges) return tl::unexpected(wedges.error());
  mesh.wedges = std::move(*wedges);
  return mesh;
}

Expected<void> MeshState::add(const BaseMesh& part, std::uint16_t k, std::uint8_t level) {
  const auto n = static_cast<std::uint32_t>(part.positions.size());
  auto closed = Connectivity::close(n, part.faces);
  if (!closed) return tl::unexpected(closed.error());
  const auto is_inside = [&](const Vec3i& cell) {
    return is_in_coordinate_bound(cell) && is_in_coordinate_bound(middle_of(cell, shift));
  };
  const auto is_bounded = [](const auto& column) {
    return std::all_of(column.values.begin(), column.values.end(), is_in_coordinate_bound);
  };
  if (!std::all_of(part.positions.begin(), part.positions.end(), is_inside) ||
      !std::all_of(part.attributes.begin(), part.attributes.end(), is_bounded)) {
    return fail(ErrorCode::kBadInput, "a vertex leaves the lattice or the range of an attribute");
  }
  connectivity.append(std::move(*closed));
  for (std::uint32_t v = 0; v < n; ++v)
    append_row(attributes, part.attributes, v);
  for (const Vec3i& cell : part.positions) {
    const VertexId v = vertex_count();
    positions.push_back(middle_of(cell, shift));
    vertex.push_back({.ordinal = ordinals[k]++,
                      .origin = k,
                      .region = k,
                      .split_level = level,
                      .visited_level = level});
    members[k].push_back(v);
    count_valence(v);
  }
  return {};
}

void MeshState::remove(const InsertedComponent& newest) {
  connectivity.drop(newest.vertices, newest.faces, newest.loops);
  for (std::uint32_t i = 0; i < newest.vertices; ++i)
    disinherit();
}

#ifdef __wasm__
void MeshState::fetch_rings(std::span<const VertexId>, std::size_t) const {}
#else
void MeshState::fetch_rings(std::span<const VertexId> order, std::size_t k) const {
  // Number of rings to prefetch at a time, and number of neighbours to prefetch per ring. Few rings
  // have more neighbours.
  constexpr std::size_t kRings = 8, kSteps = 6;
  if (k % kRings != 0) return;
  const auto soon = order.subspan(std::min(k + kRings, order.size()));
  std::array<Corner, kRings> corner;
  const std::size_t rings = std::min(soon.size(), kRings);
  for (std::size_t i = 0; i < rings; ++i)
    corner[i] = connectivity.corner_at(soon[i]);
  for (std::size_t step = 0; step < kSteps; ++step) {
    for (std::size_t i = 0; i < rings; ++i) {
      const VertexId q = connectivity.neighbour(corner[i]);
      if (!is_virtual(q)) fetch(&vertex[q]), fetch(&positions[q]);
      corner[i] = connectivity.swing(corner[i]);
    }
  }
}
#endif

void MeshState::count_valence(VertexId v) {
  const Corner first = connectivity.corner_at(v);
  Corner c = first;
  std::uint8_t& valence = vertex[v].valence;
  valence = 0;
  do {
    if (valence < 255) ++valence;
    c = connectivity.swing(c);
  } while (c != first);
}

void MeshState::inherit(VertexId v) {
  const VertexId w = vertex_count();
  positions.push_back(positions[v]);
  append_row(attributes, attributes, v);
  VertexRecord record = vertex[v];
  record.origin = record.region;
  record.ordinal = ordinals[record.region]++;
  vertex.push_back(record);
  members[record.region].push_back(w);
}

void MeshState::disinherit() {
  const VertexRecord& record = vertex[vertex_count() - 1];
  members[record.region].pop_back();
  --ordinals[record.origin];
  vertex.pop_back();
  positions.pop_back();
  for (auto& column : attributes)
    column.values.pop_back();
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

void MeshState::mark_border(VertexId v) {
  const Corner first = connectivity.corner_at(v);
  VertexRecord& record = vertex[v];
  record.is_border = false;
  Corner c = first;
  do {
    const VertexId q = connectivity.neighbour(c);
    record.is_border = !is_virtual(q) && vertex[q].region != record.region;
    c = connectivity.swing(c);
  } while (c != first && !record.is_border);
}

}  // namespace vitrine::inline codec
