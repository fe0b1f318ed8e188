// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/surroundings.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kMaxNeighbours = 64;

// The neighbours of one of a split's two vertices, without its partner, in order from the first cut
// vertex to the second.
struct HalfRing {
  std::uint32_t size = 0;
  // Corners at the vertex. The next corner in the same face is at the neighbour.
  std::array<Corner, kMaxNeighbours> corners;
  std::array<VertexId, kMaxNeighbours> vertices;
};

// Returns the corner at v in the new face (v, w, q_j) of the split. The next corner is at w.
Corner corner_of_v(const ChunkSplits& chunk, std::size_t s) {
  return 3 * (chunk.face(s) + 1);
}
// Returns the corner at w in the new face (v, q_i, w) of the split. The next corner is at v.
Corner corner_of_w(const ChunkSplits& chunk, std::size_t s) {
  return 3 * chunk.face(s) + 2;
}

HalfRing half_ring(const MeshState& mesh, Corner towards_partner) {
  HalfRing half;
  half.vertices[0] = kVirtualBit;  // stays virtual if the half ring is empty
  for (Corner c = mesh.connectivity.swing(towards_partner);
       c != towards_partner && half.size < kMaxNeighbours; c = mesh.connectivity.swing(c)) {
    half.corners[half.size] = c;
    half.vertices[half.size++] = mesh.connectivity.neighbour(c);
  }
  return half;
}

// The positions of a half ring's vertices as a chunk of `region` uses them, relative to `origin`.
// Positions and lengths are undefined for virtual vertices.
struct Spokes {
  std::array<double, kMaxNeighbours> x, y, z, length;
  std::array<bool, kMaxNeighbours> is_own;  // whether the vertex belongs to `region`

  Vec3 at(std::uint32_t k) const { return {x[k], y[k], z[k]}; }
};

Spokes spokes_of(const MeshState& mesh, const HalfRing& half, std::uint16_t region,
                 const Vec3i& origin) {
  Spokes spokes;
  for (std::uint32_t k = 0; k < half.size; ++k) {
    const VertexId q = half.vertices[k];
    spokes.is_own[k] = mesh.region_of(q) == region;
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
  Vec3 shoulders;  // sum of the positions of the neighbours next to the two cut vertices
  double distance = 0;
};

struct NeighbourSplits {
  Mean d;
  SplitError error;  // sum of the prediction errors of the splits whose D is in `d`
  // Number of neighbours that split in this level and whose D is still an estimate.
  int pending = 0;
};

// Predicts the split vertex by the parallelogram rule, from the neighbours k and k + 1 and the
// vertex beyond the edge between them (the tip). Adds the prediction and the tip to `f`, unless one
// of the three vertices is in another region.
void add_parallelogram(const MeshState& mesh, const HalfRing& half, const Spokes& spokes,
                       std::uint32_t k, std::uint16_t region, const Vec3i& origin,
                       HalfFeatures& f) {
  if (!spokes.is_own[k] || !spokes.is_own[k + 1]) return;
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

// Computes the area vector of a closed outline: the half ring of v from q_j around to q_i, then the
// half ring of w.
class OutlineArea {
 public:
  void add(const HalfRing& half, const Spokes& spokes) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (is_virtual(half.vertices[k])) continue;
      const Vec3 p = spokes.at(k);
      if (has_any_) {
        area_ += cross(last_, p);
      } else {
        first_ = p;
      }
      last_ = p, has_any_ = true;
    }
  }

  Vec3 normal() const {
    const Vec3 area = area_ + cross(last_, first_);
    const double l = length(area);
    return l > 1e-9 ? area * (1 / l) : Vec3{};
  }

 private:
  Vec3 area_, first_, last_;
  bool has_any_ = false;
};

Vec3 unit(const Vec3& v) {
  const double l = length(v);
  return l > 1e-9 ? v * (1 / l) : Vec3{};
}

// Returns floor(2^kFraction log2 x) - least, clamped to [0, count - 1].
template <int kFraction>
std::uint8_t level_of(double x, int least, int count) {
  const int level = exact::log2_bucket<kFraction>(x + 1e-6) - least;
  return static_cast<std::uint8_t>(std::clamp(level, 0, count - 1));
}

// Measures how unevenly the neighbours lie, by two sums: of the squared heights over the plane
// through v~, and of the squared deviations of the distances from the mean distance, `scale`.
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

bool gather_ring(const MeshState& mesh, VertexId v, OneRing& ring) {
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

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const OneRing& ring,
                           std::uint32_t level) {
  FlagFeatures f;
  f.is_border = mesh.vertex[v].is_border;
  f.age = static_cast<int>(level - mesh.vertex[v].split_level);
  if (f.is_border) return f;
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

RingGeometry ring_geometry(const MeshState& mesh, VertexId v, const OneRing& ring) {
  RingGeometry out;
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
    const bool known = record.region == region && !record.is_border;
    if (known) out.valence[k] = static_cast<std::int8_t>(std::min<int>(record.valence, 100));
  }
  out.scale = std::max(real > 0 ? sum / real : 1.0, 0.5);
  return out;
}

namespace {

// The one-rings of the two vertices of a split. Positions are relative to v~, in lattice units.
struct SplitRings {
  SplitRings(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s)
      : SplitRings(mesh, chunk, s, mesh.vertex[chunk.v(s)].region, chunk.splits[s].merged) {}

  HalfRing of_v, of_w;
  Spokes to_v, to_w;
  HalfFeatures v, w;
  int neighbours;  // number of neighbours, at least 1
  double scale;    // mean distance of the neighbours, lattice units, at least half a cell
  Vec3 normal;     // unit vector, or zero if there is no normal
  Vec3 chord;      // vector from q_i to q_j; zero if one of them is virtual

 private:
  SplitRings(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s, std::uint16_t region,
             const Vec3i& merged)
      : of_v(half_ring(mesh, corner_of_v(chunk, s))),
        of_w(half_ring(mesh, corner_of_w(chunk, s))),
        to_v(spokes_of(mesh, of_v, region, merged)),
        to_w(spokes_of(mesh, of_w, region, merged)),
        v(half_features(mesh, of_v, to_v, region, merged)),
        w(half_features(mesh, of_w, to_w, region, merged)),
        neighbours(std::max(v.all.count + w.all.count, 1)) {
    const double half_cell = 0.5 * static_cast<double>(1u << mesh.shift);
    scale = std::max((v.distance + w.distance) / neighbours, half_cell);
    OutlineArea outline;
    outline.add(of_v, to_v);
    outline.add(of_w, to_w);
    normal = outline.normal();
    const VertexId qj = of_v.vertices[0], qi = of_w.vertices[0];
    if (of_v.size > 0 && of_w.size > 0 && !is_virtual(qi) && !is_virtual(qj))
      chord = to_v.at(0) - to_w.at(0);
  }
};

// Averages the D of the neighbours that split in this level. Negates each D whose dot product with
// `arcs` is negative.
NeighbourSplits neighbour_splits(const MeshState& mesh, const ChunkSplits& chunk,
                                 std::span<const SplitError> errors, const SplitRings& rings,
                                 const Vec3& arcs) {
  NeighbourSplits out;
  const auto add = [&](const HalfRing& half, const Spokes& spokes) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (spokes.is_own[k]) add_neighbour_split(mesh, chunk, errors, half.vertices[k], arcs, out);
    }
  };
  add(rings.of_v, rings.to_v);
  add(rings.of_w, rings.to_w);
  return out;
}

// Candidates for D, in lattice units. D is predicted by a weighted sum of them.
struct Predictions {
  // D if each of the two vertices is at the mean of its neighbours, including the other one.
  Vec3 laplacian;
  Vec3 arcs;            // difference of the means of the two half rings
  Vec3 inner_arcs;      // like `arcs`, but without q_i and q_j
  Vec3 parallelograms;  // difference of the means of the parallelogram predictions of v and w
  Vec3 across_chord;    // vector of length `scale` in the surface, perpendicular to the chord
  Vec3 neighbours;      // mean D of the neighbours that split in this level
  Vec3 bend;            // cross product of normal and chord
  Vec3 tips;            // difference of the sums of the tips, scaled; see add_parallelogram()
  Vec3 shoulders;       // half the difference of HalfFeatures::shoulders of v and w
};

Predictions predictions_of(const SplitRings& rings, const NeighbourSplits& around,
                           const Vec3& arcs) {
  const HalfFeatures &v = rings.v, &w = rings.w;
  const auto umbrella = [](const HalfFeatures& f) { return f.all.sum * (2.0 / (f.all.count + 2)); };
  const bool inner = v.inner.count > 0 && w.inner.count > 0;
  const bool tips = v.parallelogram.count > 0 && w.parallelogram.count > 0;
  const int tip_count = std::max(v.tip.count + w.tip.count, 1);
  return {.laplacian = (umbrella(v) - umbrella(w)) * 0.5,
          .arcs = arcs,
          .inner_arcs = inner ? v.inner.value() - w.inner.value() : arcs,
          .parallelograms = tips ? v.parallelogram.value() - w.parallelogram.value()
                                 : arcs * CutModel::kArcToEdge,
          .across_chord = unit(cross(rings.normal, rings.chord)) * rings.scale,
          .neighbours = around.d.count > 0 ? around.d.value() : arcs * CutModel::kArcToEdge,
          .bend = cross(rings.normal, rings.chord),
          .tips = (v.tip.sum - w.tip.sum) * (2.0 / tip_count),
          .shoulders = (v.shoulders - w.shoulders) * 0.5};
}

// Sets `kind` and the clues, which indicate the size of the prediction's error.
void set_clues(SplitSurroundings& out, const SplitRings& rings, const NeighbourSplits& around,
               const Predictions& p) {
  using S = SplitSurroundings;
  const auto fewer = static_cast<int>(std::min(rings.of_v.size, rings.of_w.size));
  const auto more = static_cast<int>(std::max(rings.of_v.size, rings.of_w.size));
  out.kind = fewer > 4 ? 1 : 0;
  Unevenness uneven;
  uneven.add(rings.of_v, rings.to_v, out.normal, rings.scale);
  uneven.add(rings.of_w, rings.to_w, out.normal, rings.scale);
  const double inverse = 1 / rings.scale,
               per_square = inverse * inverse / std::max(uneven.count, 1);
  const double lengths = length(p.arcs) * length(rings.chord);
  const double slant = lengths > 0 ? std::fabs(dot(p.arcs, rings.chord)) / lengths : 0;
  const auto settled = 8 * std::max(rings.neighbours - around.pending, 0) / rings.neighbours;
  const int known = around.d.count;
  const auto if_known = [&](std::uint8_t level) {
    return static_cast<std::uint8_t>(known > 0 ? level + 1 : 0);
  };
  out.clues[S::kRingSizes] =
      static_cast<std::uint8_t>(std::clamp(more - 2, 0, 5) * 4 + std::clamp(fewer - 2, 0, 3));
  out.clues[S::kScale] = level_of<1>(out.scale, 0, 21);
  out.clues[S::kParallelogram] = level_of<2>(length(p.parallelograms) * inverse, -8, 17);
  out.clues[S::kHeight] = level_of<0>(uneven.height * per_square, -12, 13);
  out.clues[S::kDistance] = level_of<1>(uneven.distance * per_square, -12, 13);
  out.clues[S::kSettled] = static_cast<std::uint8_t>(settled);
  out.clues[S::kChord] = level_of<1>(length(rings.chord) * inverse, -6, 13);
  out.clues[S::kSlant] = static_cast<std::uint8_t>(std::min(static_cast<int>(slant * 12), 11));
  out.clues[S::kNeighbourError] =
      if_known(level_of<1>(around.error.all / std::max(known, 1), -20, 23));
  out.clues[S::kNeighbourNormalError] =
      if_known(level_of<0>(around.error.normal / std::max(known, 1), -18, 23));
  out.clues[S::kNeighboursFromLaplacian] =
      if_known(level_of<1>(length(p.neighbours - p.laplacian) * inverse, -14, 23));
  out.clues[S::kArcsFromLaplacian] = level_of<1>(length(p.arcs - p.laplacian) * inverse, -14, 23);
  out.clues[S::kParallelogramsFromLaplacian] =
      level_of<1>(length(p.laplacian - p.parallelograms) * inverse, -14, 23);
}

}  // namespace

SplitSurroundings split_surroundings(const MeshState& mesh, const ChunkSplits& chunk,
                                     std::span<const SplitError> errors) {
  const SplitRings rings(mesh, chunk, errors.size());
  const Vec3 arcs = rings.v.all.value() - rings.w.all.value();
  const NeighbourSplits around = neighbour_splits(mesh, chunk, errors, rings, arcs);
  const Predictions p = predictions_of(rings, around, arcs);

  // Converts lattice units to cells. The factor is a power of two, so nothing is rounded.
  const double cells = 1.0 / static_cast<double>(1u << mesh.shift);
  SplitSurroundings out;
  out.scale = rings.scale * cells;
  out.normal = rings.normal;
  out.features = {p.laplacian,  p.arcs, p.inner_arcs, p.parallelograms, p.across_chord,
                  p.neighbours, p.bend, p.tips,       p.shoulders};
  for (Vec3& feature : out.features)
    feature = feature * cells;
  set_clues(out, rings, around, p);
  return out;
}

namespace {

// Returns the mean value of an attribute over the half ring of v, minus the mean over the half ring
// of the new vertex.
Vec3 half_ring_difference(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s,
                          std::size_t column) {
  const Segments<Vec3i>& values = mesh.attributes[column].values;
  const auto mean = [&](Corner towards_partner) {
    const HalfRing half = half_ring(mesh, towards_partner);
    Mean m;
    for (std::uint32_t k = 0; k < half.size; ++k) {
      if (!is_virtual(half.vertices[k])) m.add(to_vec3(values[half.vertices[k]]));
    }
    return m.count > 0 ? m.value() : to_vec3(chunk.merged_attributes[column][s]);
  };
  return mean(corner_of_v(chunk, s)) - mean(corner_of_w(chunk, s));
}

}  // namespace

Vec3 predicted_difference(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s,
                          std::size_t column) {
  switch (mesh.attributes[column].semantic) {
    case Semantic::kColour:
      break;
  }
  return half_ring_difference(mesh, chunk, s, column);
}

}  // namespace vitrine::inline codec
