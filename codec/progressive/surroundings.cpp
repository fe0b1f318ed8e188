// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/surroundings.h"

namespace vitrine {
namespace {

constexpr std::uint32_t kMaxNeighbours = 64;

// The neighbours of one vertex of a split but the other one, from cut vertex to cut vertex.
struct HalfRing {
  std::uint32_t size = 0;
  std::array<Corner, kMaxNeighbours> corners;  // at the vertex; the face's next is the neighbour
  std::array<VertexId, kMaxNeighbours> vertices;
};

// The corners at the two vertices of a split in its new faces, the next of which is the other one.
Corner corner_of_v(const ChunkSplits& chunk, std::size_t s) {
  return 3 * (chunk.face(s) + 1);
}
Corner corner_of_w(const ChunkSplits& chunk, std::size_t s) {
  return 3 * chunk.face(s) + 2;
}

HalfRing half_ring(const MeshState& mesh, Corner towards_partner) {
  HalfRing half;
  half.vertices[0] = kVirtualBit;  // where there is none
  for (Corner c = mesh.connectivity.swing(towards_partner);
       c != towards_partner && half.size < kMaxNeighbours; c = mesh.connectivity.swing(c)) {
    half.corners[half.size] = c;
    half.vertices[half.size++] = mesh.connectivity.neighbour(c);
  }
  return half;
}

// Where the vertices of a half ring are, as a chunk of `region` sees them, relative to `origin`.
// Without a meaning where a vertex is virtual.
struct Spokes {
  std::array<double, kMaxNeighbours> x, y, z, length;
  std::array<bool, kMaxNeighbours> own;  // of the region

  Vec3 at(std::uint32_t k) const { return {x[k], y[k], z[k]}; }
};

Spokes spokes_of(const MeshState& mesh, const HalfRing& half, std::uint16_t region,
                 const Vec3i& origin) {
  Spokes spokes;
  for (std::uint32_t k = 0; k < half.size; ++k) {
    const VertexId q = half.vertices[k];
    spokes.own[k] = mesh.region_of(q) == region;
    if (is_virtual(q)) continue;
    const Vec3 p = to_vec3(mesh.seen_from(region, q) - origin);
    spokes.x[k] = p.x, spokes.y[k] = p.y, spokes.z[k] = p.z;
    spokes.length[k] = length(p);
  }
  return spokes;
}

struct Mean {
  Vec3 sum;
  int count = 0;

  void add(const Vec3& p) { sum += p, ++count; }
  Vec3 value() const { return count > 0 ? sum * (1.0 / count) : Vec3{}; }
};

struct HalfFeatures {
  Mean all, inner, parallelogram, tip;
  Vec3 shoulders;  // sum of the neighbours next to the two cut vertices
  double distance = 0;
};

struct NeighbourSplits {
  Mean d;
  SplitError error;  // sums over d's predictions
  int pending = 0;   // splits of this level that are still estimates
};

// Parallelogram prediction of the vertex across the edge that faces it.
void add_parallelogram(const MeshState& mesh, const HalfRing& half, const Spokes& spokes,
                       std::uint32_t k, std::uint16_t region, const Vec3i& origin,
                       HalfFeatures& f) {
  if (!spokes.own[k] || !spokes.own[k + 1]) return;
  const VertexId tip = mesh.connectivity.vertex(mesh.connectivity.opposite(half.corners[k]));
  if (mesh.region_of(tip) != region) return;
  const Vec3 across = to_vec3(mesh.positions[tip] - origin);
  f.parallelogram.add(spokes.at(k) + spokes.at(k + 1) - across);
  f.tip.add(across);
}

void add_neighbour_split(const MeshState& mesh, const ChunkSplits& chunk,
                         std::span<const SplitError> errors, VertexId q, const Vec3& sense,
                         NeighbourSplits& out) {
  const std::uint32_t t = mesh.vertex[q].split_of;
  if (t >= chunk.size() || (chunk.v(t) != q && chunk.w(t) != q)) return;
  if (t >= errors.size()) {
    ++out.pending;
    return;
  }
  const Vec3 d = to_vec3(mesh.positions[chunk.v(t)] - mesh.positions[chunk.w(t)]);
  out.d.add(dot(d, sense) < 0 ? d * -1.0 : d);
  out.error.all += errors[t].all;
  out.error.normal += errors[t].normal;
}

HalfFeatures half_features(const MeshState& mesh, const HalfRing& half, const Spokes& spokes,
                           std::uint16_t region, const Vec3i& origin) {
  HalfFeatures f;
  for (std::uint32_t k = 0; k < half.size; ++k) {
    if (is_virtual(half.vertices[k])) continue;
    const Vec3 p = spokes.at(k);
    f.all.add(p);
    f.distance += spokes.length[k];
    if (k > 0 && k + 1 < half.size) {
      f.inner.add(p);
      if (k == 1) f.shoulders += p;
      if (k + 2 == half.size) f.shoulders += p;
    }
    if (k + 1 < half.size) add_parallelogram(mesh, half, spokes, k, region, origin, f);
  }
  return f;
}

// Area vector of the closed outline: the half ring of v from q_j round to q_i, then that of w.
class Outline {
 public:
  void add(const HalfRing& half, const Spokes& spokes) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (is_virtual(half.vertices[k])) continue;
      const Vec3 p = spokes.at(k);
      if (any_) {
        area_ += cross(last_, p);
      } else {
        first_ = p;
      }
      last_ = p, any_ = true;
    }
  }

  Vec3 normal() const {
    const Vec3 area = area_ + cross(last_, first_);
    const double l = length(area);
    return l > 1e-9 ? area * (1 / l) : Vec3{};
  }

 private:
  Vec3 area_, first_, last_;
  bool any_ = false;
};

Vec3 unit(const Vec3& v) {
  const double l = length(v);
  return l > 1e-9 ? v * (1 / l) : Vec3{};
}

// floor(2^kFraction log2 x) from `least` on, as one of `count` levels.
template <int kFraction>
std::uint8_t level_of(double x, int least, int count) {
  const int level = exact::log2_bucket<kFraction>(x + 1e-6) - least;
  return static_cast<std::uint8_t>(std::clamp(level, 0, count - 1));
}

// How the neighbours lie: mean squares of their heights above the plane and of their distances'
// deviations from the mean distance.
struct Unevenness {
  double height = 0, distance = 0;
  int count = 0;

  void add(const HalfRing& half, const Spokes& spokes, const Vec3& normal, double scale) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (is_virtual(half.vertices[k])) continue;
      const double h = dot(spokes.at(k), normal), l = spokes.length[k] - scale;
      height += h * h, distance += l * l, ++count;
    }
  }
};

}  // namespace

bool gather_ring(const MeshState& mesh, VertexId v, Ring& ring) {
  std::array<Corner, kMaxSplitValence> corners;
  ring.size = mesh.connectivity.ring(v, corners);
  if (ring.size == 0) return false;
  std::uint32_t start = 0;
  std::uint64_t smallest = ~std::uint64_t{0};
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const std::uint64_t id = mesh.canonical(mesh.connectivity.neighbour(corners[k]));
    if (id < smallest) smallest = id, start = k;
  }
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const std::uint32_t from = start + k < ring.size ? start + k : start + k - ring.size;
    ring.corners[k] = corners[from];
    ring.vertices[k] = mesh.connectivity.neighbour(corners[from]);
  }
  return true;
}

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const Ring& ring,
                           std::uint32_t level) {
  FlagFeatures f;
  f.border = mesh.vertex[v].border;
  f.age = static_cast<int>(level - mesh.vertex[v].split_level);
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
    if (mesh.vertex[q].split_level == level) {
      ++f.split;
    } else if (mesh.vertex[q].visited_level == level) {
      ++f.unsplit;
    }
  }
  f.square_length = real > 0 ? sum / real : 0;
  return f;
}

CutRing cut_ring(const MeshState& mesh, VertexId v, const Ring& ring) {
  CutRing out;
  const std::uint16_t region = mesh.vertex[v].region;
  out.size = ring.size;
  double sum = 0;
  int real = 0;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const VertexId q = ring.vertices[k];
    out.valence[k] = 6;
    out.is_virtual[k] = is_virtual(q);
    if (out.is_virtual[k]) continue;
    out.at[k] = to_vec3(mesh.seen_from(region, q) - mesh.positions[v]);
    sum += length(out.at[k]);
    ++real;
    const VertexRecord& record = mesh.vertex[q];
    const bool known = record.region == region && !record.border;
    if (known) out.valence[k] = static_cast<std::int8_t>(std::min<int>(record.valence, 100));
  }
  out.scale = std::max(real > 0 ? sum / real : 1.0, 0.5);
  return out;
}

SplitSurroundings split_surroundings(const MeshState& mesh, const ChunkSplits& chunk,
                                     std::span<const SplitError> errors) {
  const std::size_t s = errors.size();
  const Split& split = chunk.splits[s];
  const std::uint16_t region = mesh.vertex[split.v].region;
  const HalfRing of_v = half_ring(mesh, corner_of_v(chunk, s));
  const HalfRing of_w = half_ring(mesh, corner_of_w(chunk, s));
  const Spokes to_v = spokes_of(mesh, of_v, region, split.merged);
  const Spokes to_w = spokes_of(mesh, of_w, region, split.merged);
  const HalfFeatures v = half_features(mesh, of_v, to_v, region, split.merged);
  const HalfFeatures w = half_features(mesh, of_w, to_w, region, split.merged);

  SplitSurroundings out;
  const int neighbours = std::max(v.all.count + w.all.count, 1);
  // From lattice units to cells; a power of two, so nothing is rounded.
  const double cells = 1.0 / static_cast<double>(1u << mesh.shift);
  const double scale = std::max((v.distance + w.distance) / neighbours, 0.5 / cells);
  out.scale = scale * cells;
  Outline outline;
  outline.add(of_v, to_v);
  outline.add(of_w, to_w);
  out.normal = outline.normal();

  const Vec3 arcs = v.all.value() - w.all.value();
  const bool inner = v.inner.count > 0 && w.inner.count > 0;
  const bool tips = v.parallelogram.count > 0 && w.parallelogram.count > 0;
  const Vec3 inner_arcs = inner ? v.inner.value() - w.inner.value() : arcs;
  const Vec3 parallelograms =
      tips ? v.parallelogram.value() - w.parallelogram.value() : arcs * CutModel::kArcToEdge;
  const int tip_count = std::max(v.tip.count + w.tip.count, 1);
  const Vec3 tip_arcs = (v.tip.sum - w.tip.sum) * (2.0 / tip_count);

  Vec3 chord;
  const VertexId qj = of_v.vertices[0], qi = of_w.vertices[0];
  if (of_v.size > 0 && of_w.size > 0 && !is_virtual(qi) && !is_virtual(qj)) {
    chord = to_v.at(0) - to_w.at(0);
  }
  NeighbourSplits around;
  const auto add_neighbour_splits = [&](const HalfRing& half, const Spokes& spokes) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (spokes.own[k]) add_neighbour_split(mesh, chunk, errors, half.vertices[k], arcs, around);
    }
  };
  add_neighbour_splits(of_v, to_v);
  add_neighbour_splits(of_w, to_w);
  const Vec3 across = unit(cross(out.normal, chord)) * scale;
  const int known = around.d.count;
  const Vec3 neighbour_d = known > 0 ? around.d.value() : arcs * CutModel::kArcToEdge;
  // Both vertices in the middle of their neighbours, one of which is the other vertex.
  const auto umbrella = [](const HalfFeatures& f) { return f.all.sum * (2.0 / (f.all.count + 2)); };
  const Vec3 laplace = (umbrella(v) - umbrella(w)) * 0.5;
  out.features = {laplace,
                  arcs,
                  inner_arcs,
                  parallelograms,
                  across,
                  neighbour_d,
                  cross(out.normal, chord),
                  tip_arcs,
                  (v.shoulders - w.shoulders) * 0.5};
  for (Vec3& feature : out.features)
    feature = feature * cells;

  const auto fewer = static_cast<int>(std::min(of_v.size, of_w.size));
  const auto more = static_cast<int>(std::max(of_v.size, of_w.size));
  out.kind = fewer > 4 ? 1 : 0;
  Unevenness uneven;
  uneven.add(of_v, to_v, out.normal, scale);
  uneven.add(of_w, to_w, out.normal, scale);
  const double inverse = 1 / scale, per_square = inverse * inverse / std::max(uneven.count, 1);
  const double lengths = length(arcs) * length(chord);
  const double slant = lengths > 0 ? std::fabs(dot(arcs, chord)) / lengths : 0;
  const auto settled = 8 * std::max(neighbours - around.pending, 0) / neighbours;
  const auto if_known = [&](std::uint8_t level) {
    return static_cast<std::uint8_t>(known > 0 ? level + 1 : 0);
  };
  out.clues = {
      static_cast<std::uint8_t>(std::clamp(more - 2, 0, 5) * 4 + std::clamp(fewer - 2, 0, 3)),
      level_of<1>(out.scale, 0, 21),
      level_of<2>(length(parallelograms) * inverse, -8, 17),
      level_of<0>(uneven.height * per_square, -12, 13),
      level_of<1>(uneven.distance * per_square, -12, 13),
      static_cast<std::uint8_t>(settled),
      level_of<1>(length(chord) * inverse, -6, 13),
      static_cast<std::uint8_t>(std::min(static_cast<int>(slant * 12), 11)),
      if_known(level_of<1>(around.error.all / std::max(known, 1), -20, 23)),
      if_known(level_of<0>(around.error.normal / std::max(known, 1), -18, 23)),
      if_known(level_of<1>(length(neighbour_d - laplace) * inverse, -14, 23)),
      level_of<1>(length(arcs - laplace) * inverse, -14, 23),
      level_of<1>(length(laplace - parallelograms) * inverse, -14, 23)};
  return out;
}

Vec3 colour_difference(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s) {
  const auto mean = [&](Corner towards_partner) {
    const HalfRing half = half_ring(mesh, towards_partner);
    Mean m;
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (!is_virtual(half.vertices[k])) m.add(to_vec3(mesh.colours[half.vertices[k]]));
    }
    return m.count > 0 ? m.value() : to_vec3(chunk.merged_colours[s]);
  };
  return mean(corner_of_v(chunk, s)) - mean(corner_of_w(chunk, s));
}

}  // namespace vitrine
