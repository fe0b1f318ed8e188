// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/surroundings.h"

namespace vitrine {
namespace {

constexpr std::uint32_t kMaxNeighbours = 64;

// The neighbours of one vertex of a split but the other one, from cut vertex to cut vertex.
struct HalfRing {
  std::uint32_t size = 0;
  std::array<Corner, kMaxNeighbours> corners{};  // at the vertex; the face's next is the neighbour
  std::array<VertexId, kMaxNeighbours> vertices{};
};

HalfRing half_ring(const MeshState& mesh, Corner towards_partner) {
  HalfRing half;
  for (Corner c = mesh.connectivity.swing(towards_partner);
       c != towards_partner && half.size < kMaxNeighbours; c = mesh.connectivity.swing(c)) {
    half.corners[half.size] = c;
    half.vertices[half.size++] = mesh.connectivity.vertex(next(c));
  }
  return half;
}

struct Mean {
  Vec3 sum;
  int count = 0;

  void add(const Vec3& p) { sum += p, ++count; }
  Vec3 value() const { return count > 0 ? sum * (1.0 / count) : Vec3{}; }
};

struct HalfFeatures {
  Mean all, inner, parallelogram, neighbour_d;
  double distance = 0;
  double error = 0;  // of neighbour_d's predictions, relative to their scale
  int pending = 0;   // neighbours of the region that split in this level and are still estimates
};

// Parallelogram prediction of the vertex across the edge that faces it.
void add_parallelogram(const MeshState& mesh, const HalfRing& half, std::uint32_t k,
                       std::uint16_t region, const Vec3i& origin, HalfFeatures& f) {
  const VertexId a = half.vertices[k], b = half.vertices[k + 1];
  if (mesh.region_of(a) != region || mesh.region_of(b) != region) return;
  const VertexId tip = mesh.connectivity.vertex(mesh.connectivity.opposite(half.corners[k]));
  if (mesh.region_of(tip) != region) return;
  f.parallelogram.add(
      to_vec3(mesh.positions[a] + mesh.positions[b] - mesh.positions[tip] - origin));
}

void add_neighbour_d(const MeshState& mesh, std::span<const Split> splits, std::size_t s,
                     VertexId q, HalfFeatures& f, const Vec3& sense) {
  const std::uint32_t t = mesh.split_of[q];
  if (t >= splits.size() || (splits[t].v != q && splits[t].w != q)) return;
  if (t >= s) {
    ++f.pending;
    return;
  }
  const Vec3 d = to_vec3(mesh.positions[splits[t].v] - mesh.positions[splits[t].w]);
  f.neighbour_d.add(dot(d, sense) < 0 ? d * -1.0 : d);
  f.error += splits[t].error;
}

HalfFeatures half_features(const MeshState& mesh, const HalfRing& half, std::uint16_t region,
                           const Vec3i& origin) {
  HalfFeatures f;
  for (std::uint32_t k = 0; k < half.size; ++k) {
    const VertexId q = half.vertices[k];
    if (is_virtual(q)) continue;
    const Vec3 p = to_vec3(mesh.positions[q] - origin);
    f.all.add(p);
    f.distance += length(p);
    if (k > 0 && k + 1 < half.size) f.inner.add(p);
    if (k + 1 < half.size) add_parallelogram(mesh, half, k, region, origin, f);
  }
  return f;
}

// Area vector of the closed outline: the half ring of v from q_j round to q_i, then that of w.
Vec3 outline_normal(const MeshState& mesh, const HalfRing& a, const HalfRing& b,
                    const Vec3i& origin) {
  Vec3 area, first, last;
  bool any = false;
  const auto visit = [&](const HalfRing& half) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (is_virtual(half.vertices[k])) continue;
      const Vec3 p = to_vec3(mesh.positions[half.vertices[k]] - origin);
      if (any) {
        area += cross(last, p);
      } else {
        first = p;
      }
      last = p, any = true;
    }
  };
  visit(a);
  visit(b);
  area += cross(last, first);
  const double l = length(area);
  return l > 1e-9 ? area * (1 / l) : Vec3{};
}

Vec3 unit(const Vec3& v) {
  const double l = length(v);
  return l > 1e-9 ? v * (1 / l) : Vec3{};
}

}  // namespace

bool gather_ring(const MeshState& mesh, VertexId v, Ring& ring) {
  std::array<Corner, kMaxSplitValence> corners;
  ring.size = mesh.connectivity.ring(v, corners);
  if (ring.size == 0) return false;
  std::uint32_t start = 0;
  std::uint64_t smallest = ~std::uint64_t{0};
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const std::uint64_t id = mesh.canonical(mesh.connectivity.vertex(next(corners[k])));
    if (id < smallest) smallest = id, start = k;
  }
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const std::uint32_t from = start + k < ring.size ? start + k : start + k - ring.size;
    ring.corners[k] = corners[from];
    ring.vertices[k] = mesh.connectivity.vertex(next(corners[from]));
  }
  return true;
}

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const Ring& ring,
                           std::uint32_t level) {
  FlagFeatures f;
  f.border = mesh.border[v] != 0;
  f.age = static_cast<int>(level - mesh.split_level[v]);
  if (f.border) return f;
  f.valence = static_cast<int>(ring.size);
  double sum = 0;
  int real = 0;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const VertexId q = ring.vertices[k];
    if (is_virtual(q)) continue;
    const Vec3 edge = to_vec3(mesh.positions[q] - mesh.positions[v]);
    sum += dot(edge, edge);
    ++real;
    if (mesh.split_level[q] == level) {
      ++f.split;
    } else if (mesh.visited_level[q] == level) {
      ++f.unsplit;
    }
  }
  f.square_length = real > 0 ? sum / real : 0;
  return f;
}

CutRing cut_ring(const MeshState& mesh, VertexId v, const Ring& ring) {
  CutRing out;
  out.size = ring.size;
  double sum = 0;
  int real = 0;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const VertexId q = ring.vertices[k];
    out.valence[k] = 6;
    out.is_virtual[k] = is_virtual(q);
    if (out.is_virtual[k]) continue;
    out.at[k] = to_vec3(mesh.positions[q] - mesh.positions[v]);
    sum += length(out.at[k]);
    ++real;
    const bool known = mesh.region[q] == mesh.region[v] && mesh.border[q] == 0;
    if (known) out.valence[k] = static_cast<std::int8_t>(std::min<int>(mesh.valence[q], 100));
  }
  out.scale = std::max(real > 0 ? sum / real : 1.0, 0.5);
  return out;
}

SplitSurroundings split_surroundings(const MeshState& mesh, std::span<const Split> splits,
                                     std::size_t s) {
  const Split& split = splits[s];
  const std::uint16_t region = mesh.region[split.v];
  const HalfRing of_v = half_ring(mesh, 3 * (split.new_face + 1));
  const HalfRing of_w = half_ring(mesh, 3 * split.new_face + 2);
  HalfFeatures v = half_features(mesh, of_v, region, split.merged);
  HalfFeatures w = half_features(mesh, of_w, region, split.merged);

  SplitSurroundings out;
  const int neighbours = std::max(v.all.count + w.all.count, 1);
  out.scale = std::max((v.distance + w.distance) / neighbours, 0.5);
  out.normal = outline_normal(mesh, of_v, of_w, split.merged);

  const Vec3 arcs = v.all.value() - w.all.value();
  const bool inner = v.inner.count > 0 && w.inner.count > 0;
  const bool tips = v.parallelogram.count > 0 && w.parallelogram.count > 0;
  const Vec3 inner_arcs = inner ? v.inner.value() - w.inner.value() : arcs;
  const Vec3 parallelograms =
      tips ? v.parallelogram.value() - w.parallelogram.value() : arcs * CutModel::kArcToEdge;

  Vec3 chord;
  const VertexId qj = of_v.vertices[0], qi = of_w.vertices[0];
  if (of_v.size > 0 && of_w.size > 0 && !is_virtual(qi) && !is_virtual(qj)) {
    chord = to_vec3(mesh.positions[qj] - mesh.positions[qi]);
  }
  HalfFeatures around;
  for (const HalfRing* half : {&of_v, &of_w}) {
    for (std::uint32_t k = 0; k < half->size; ++k) {
      const VertexId q = half->vertices[k];
      if (mesh.region_of(q) == region) add_neighbour_d(mesh, splits, s, q, around, arcs);
    }
  }
  const Vec3 across = unit(cross(out.normal, chord)) * out.scale;
  const Vec3 neighbour_d =
      around.neighbour_d.count > 0 ? around.neighbour_d.value() : arcs * CutModel::kArcToEdge;
  // Both vertices in the middle of their neighbours, one of which is the other vertex.
  const auto umbrella = [](const HalfFeatures& f) { return f.all.sum * (2.0 / (f.all.count + 2)); };
  const Vec3 laplace = (umbrella(v) - umbrella(w)) * 0.5;
  out.features = {
      laplace, arcs, inner_arcs, parallelograms, across, neighbour_d, cross(out.normal, chord)};
  const double disagreement = length(laplace - parallelograms) / out.scale;
  const int bucket = std::clamp(exact::log2_bucket<1>(disagreement + 1e-6) + 6, 0, 6);
  const int known = around.neighbour_d.count;
  const int rough =
      known == 0 ? 0 : std::clamp(exact::log2_bucket<0>(around.error / known + 1e-6) + 6, 1, 5);
  out.context = (bucket * 6 + rough) * 2 + (2 * around.pending > neighbours ? 1 : 0);
  return out;
}

Vec3 colour_difference(const MeshState& mesh, const Split& split) {
  const auto mean = [&](Corner towards_partner) {
    const HalfRing half = half_ring(mesh, towards_partner);
    Mean m;
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (!is_virtual(half.vertices[k])) m.add(to_vec3(mesh.colours[half.vertices[k]]));
    }
    return m.count > 0 ? m.value() : to_vec3(split.merged_colour);
  };
  return mean(3 * (split.new_face + 1)) - mean(3 * split.new_face + 2);
}

}  // namespace vitrine
