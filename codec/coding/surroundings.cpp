// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/surroundings.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kMaxNeighbours = 64;
constexpr std::uint32_t kNoSplit = 0xFFFF'FFFFu;

// The neighbours of one vertex of a split, without the split's other vertex, in ring order from one
// cut vertex to the other.
struct HalfRing {
  std::uint32_t size = 0;
  // Corners at the vertex, one for each neighbour. The neighbour is at the next corner of the same
  // face.
  std::array<Corner, kMaxNeighbours> corners;
  std::array<VertexId, kMaxNeighbours> vertices;
};

// Returns the corner at v in the split's new face (v, w, q_j). The face's next corner is at w.
Corner corner_of_v(const ChunkSplits& chunk, std::size_t s) {
  return 3 * (chunk.face(s) + 1);
}
// Returns the corner at w in the split's new face (v, q_i, w). The face's next corner is at v.
Corner corner_of_w(const ChunkSplits& chunk, std::size_t s) {
  return 3 * chunk.face(s) + 2;
}

HalfRing half_ring(const MeshState& mesh, Corner towards_partner) {
  HalfRing half;
  half.vertices[0] = kVirtualBit;  // if there are no neighbours, the first vertex counts as virtual
  std::uint32_t size = 0;
  for (Corner c = mesh.connectivity.swing(towards_partner);
       c != towards_partner && size < kMaxNeighbours; c = mesh.connectivity.swing(c)) {
    half.corners[size] = c;
    half.vertices[size++] = mesh.connectivity.neighbour(c);
  }
  half.size = size;
  return half;
}

// The vectors from a given origin to the vertices of a half ring. Uses the positions that
// MeshState::seen_from() returns. The values of virtual vertices are undefined.
struct Spokes {
  std::array<double, kMaxNeighbours> x, y, z, length;
  std::array<bool, kMaxNeighbours> is_own;  // whether the vertex is in the chunk's region
  // Index of the split of this chunk that the vertex takes part in, or kNoSplit.
  std::array<std::uint32_t, kMaxNeighbours> split;

  Vec3 at(std::uint32_t k) const { return {x[k], y[k], z[k]}; }
};

// `centre` is the record of the vertex whose neighbours form the half ring.
Spokes spokes_of(const MeshState& mesh, const HalfRing& half, const VertexRecord& centre,
                 const Vec3i& origin) {
  Spokes spokes;
  for (std::uint32_t k = 0; k < half.size; ++k) {
    const VertexId q = half.vertices[k];
    spokes.is_own[k] = false, spokes.split[k] = kNoSplit;
    if (is_virtual(q)) continue;
    const VertexRecord& record = mesh.vertex[q];
    spokes.is_own[k] = record.region == centre.region;
    // A neighbour in the same region whose last split was in this level was split by this chunk.
    const bool split = spokes.is_own[k] & (record.split_level == centre.split_level);
    spokes.split[k] = record.split_of | (kNoSplit * static_cast<std::uint32_t>(!split));
    const Vec3 p = to_vec3(mesh.seen_from(centre.region, q) - origin);
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

// Sums over those neighbours of a split's vertices that also split in this level. D is the
// difference of the positions of a split's two vertices (displacement_model.h).
struct NeighbourSplits {
  Mean d;
  SplitError error;  // sum of the prediction errors of the splits counted in `d`
  // Number of neighbours that split in this level, but whose D is not yet known.
  int pending = 0;
};

// Predicts the position of a split's vertex as the fourth corner of a parallelogram. Its other
// corners are the neighbours k and k + 1, and the tip, which lies across the edge between these
// two. Adds the prediction and the tip to the two means, unless one of the three vertices is in
// another region.
void add_parallelogram(const MeshState& mesh, const HalfRing& half, const Spokes& spokes,
                       std::uint32_t k, std::uint16_t region, const Vec3i& origin,
                       Mean& parallelogram, Mean& tips) {
  if (!spokes.is_own[k] || !spokes.is_own[k + 1]) return;
  const VertexId tip = mesh.connectivity.vertex(mesh.connectivity.opposite(half.corners[k]));
  if (mesh.region_of(tip) != region) return;
  const Vec3 across = to_vec3(mesh.positions[tip] - origin);
  parallelogram.add(spokes.at(k) + spokes.at(k + 1) - across);
  tips.add(across);
}

HalfFeatures half_features(const MeshState& mesh, const HalfRing& half, const Spokes& spokes,
                           std::uint16_t region, const Vec3i& origin) {
  // Uses separate variables: they stay in registers, and no whole HalfFeatures has to be cleared.
  Mean all, inner, parallelogram, tip;
  Vec3 shoulders;
  double distance = 0;
  const auto is_real = [&](std::uint32_t k) { return !is_virtual(half.vertices[k]); };
  for (std::uint32_t k = 0; k < half.size; ++k) {
    if (is_real(k)) all.add(spokes.at(k)), distance += spokes.length[k];
  }
  for (std::uint32_t k = 0; k + 1 < half.size; ++k)
    add_parallelogram(mesh, half, spokes, k, region, origin, parallelogram, tip);
  for (std::uint32_t k = 1; k + 1 < half.size; ++k) {
    if (is_real(k)) inner.add(spokes.at(k));
  }
  if (half.size > 2) {
    if (is_real(1)) shoulders += spokes.at(1);
    if (is_real(half.size - 2)) shoulders += spokes.at(half.size - 2);
  }
  return {all, inner, parallelogram, tip, shoulders, distance};
}

// Computes the area vector of the closed outline of a split: the half ring of v from q_j to q_i,
// then the half ring of w.
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

// Returns floor(2^kFraction * log2(x)) - least, clamped to [0, count - 1].
template <int kFraction>
std::uint8_t level_of(double x, int least, int count) {
  const int level = exact::log2_bucket<kFraction>(x + 1e-6) - least;
  return static_cast<std::uint8_t>(std::clamp(level, 0, count - 1));
}

// Measures how uneven the surface is around the merged vertex, which is the vertex before the
// split. `height` and `distance` are sums over its real neighbours. `height` sums squared distances
// from the tangent plane at the merged vertex. `distance` sums the squared differences between the
// neighbours' distances from the merged vertex and their mean distance.
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
  const Corner first = mesh.connectivity.corner_at(v);
  Corner c = first;
  std::uint32_t size = 0;
  do {
    if (size == kMaxSplitValence) return false;
    ring.corners[size] = c;
    ring.vertices[size++] = mesh.connectivity.neighbour(c);
    c = mesh.connectivity.swing(c);
  } while (c != first);
  ring.size = size;
  return true;
}

void start_canonically(const MeshState& mesh, OneRing& ring) {
  std::uint32_t start = 0;
  std::uint64_t smallest = ~std::uint64_t{0};
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const std::uint64_t id = mesh.canonical(ring.vertices[k]);
    start = id < smallest ? k : start;
    smallest = std::min(id, smallest);
  }
  const OneRing any = ring;
  std::rotate_copy(any.corners.begin(), any.corners.begin() + start,
                   any.corners.begin() + ring.size, ring.corners.begin());
  std::rotate_copy(any.vertices.begin(), any.vertices.begin() + start,
                   any.vertices.begin() + ring.size, ring.vertices.begin());
}

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const OneRing& ring,
                           std::uint32_t level) {
  FlagFeatures f;
  f.is_border = mesh.vertex[v].is_border;
  f.age = static_cast<int>(level - mesh.vertex[v].split_level);
  if (f.is_border) return f;
  f.valence = static_cast<int>(ring.size);
  const Vec3i centre = mesh.positions[v];
  // Any order of summation gives the same result, because sums of integers below 2^53 are exact.
  double sum = 0;
  int real = 0;
  for (std::uint32_t k = 0; k < ring.size; ++k) {
    const VertexId q = ring.vertices[k];
    if (is_virtual(q)) continue;
    const Vec3 edge = to_vec3(mesh.positions[q] - centre);
    sum += dot(edge, edge);
    ++real;
    const VertexRecord& record = mesh.vertex[q];
    const bool split = record.split_level == level;
    f.split += split ? 1 : 0;
    f.unsplit += static_cast<int>(!split & (record.visited_level == level));
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
    out.place(k, {});
    if (out.is_virtual[k]) continue;
    const Vec3 p = to_vec3(mesh.seen_from(region, q) - mesh.positions[v]);
    out.place(k, p);
    sum += length(p);
    ++real;
    const VertexRecord& record = mesh.vertex[q];
    const bool known = record.region == region && !record.is_border;
    if (known) out.valence[k] = static_cast<std::int8_t>(std::min<int>(record.valence, 100));
  }
  out.scale = std::max(real > 0 ? sum / real : 1.0, 0.5);
  return out;
}

namespace {

// The one-rings of a split's two vertices. Positions are relative to the vertex before the split,
// in lattice units.
struct SplitRings {
  SplitRings(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s)
      : SplitRings(mesh, chunk, s, mesh.vertex[chunk.v(s)], chunk.splits[s].merged) {}

  HalfRing of_v, of_w;
  Spokes to_v, to_w;
  HalfFeatures v, w;
  int neighbours;  // number of neighbours, at least 1
  double scale;    // mean distance of the neighbours, at least half a cell
  Vec3 normal;     // unit normal of the surface, or zero if undefined
  Vec3 chord;      // vector from cut vertex q_i to cut vertex q_j; zero if one is virtual

 private:
  SplitRings(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s,
             const VertexRecord& record, const Vec3i& merged)
      : of_v(half_ring(mesh, corner_of_v(chunk, s))),
        of_w(half_ring(mesh, corner_of_w(chunk, s))),
        to_v(spokes_of(mesh, of_v, record, merged)),
        to_w(spokes_of(mesh, of_w, record, merged)),
        v(half_features(mesh, of_v, to_v, record.region, merged)),
        w(half_features(mesh, of_w, to_w, record.region, merged)),
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

// Averages D over the neighbours that split in this level. Negates each D that points away from
// `arcs` (negative dot product). Branches on whether a neighbour counts, or on the sign of its D,
// would often be mispredicted, so this function avoids them.
NeighbourSplits neighbour_splits(std::span<const PlacedSplit> placed, const SplitRings& rings,
                                 const Vec3& arcs) {
  NeighbourSplits out;
  std::array<std::uint32_t, 2 * kMaxNeighbours> settled;
  std::uint32_t count = 0;
  const auto collect = [&](const HalfRing& half, const Spokes& spokes) {
    for (std::uint32_t k = 0; k < half.size; ++k) {
      const std::uint32_t t = spokes.split[k];
      const bool is_settled = t < placed.size();
      settled[count] = t;
      count += static_cast<std::uint32_t>(is_settled);
      out.pending += static_cast<int>(t != kNoSplit) - static_cast<int>(is_settled);
    }
  };
  collect(rings.of_v, rings.to_v);
  collect(rings.of_w, rings.to_w);
  for (std::uint32_t k = 0; k < count; ++k) {
    const PlacedSplit& split = placed[settled[k]];
    out.d.add(split.d * (dot(split.d, arcs) < 0 ? -1.0 : 1.0));
    out.error.all += split.error.all;
    out.error.normal += split.error.normal;
  }
  return out;
}

// Predictions of D, the difference of the positions of a split's two vertices
// (displacement_model.h), in lattice units. The final prediction is a weighted sum of them.
struct Predictions {
  // D if each of the two vertices lies at the mean of its neighbours, which include the other
  // vertex.
  Vec3 laplacian;
  Vec3 arcs;            // mean of v's half ring minus mean of w's half ring
  Vec3 inner_arcs;      // like `arcs`, but without the two cut vertices
  Vec3 parallelograms;  // mean parallelogram prediction of v minus that for w
  Vec3 across_chord;    // vector of length `scale` in the surface, perpendicular to the chord
  Vec3 neighbours;      // mean D of the neighbours that split in this level
  Vec3 bend;            // cross product of `normal` and SplitRings::chord
  Vec3 tips;            // scaled difference of the two sums of tips (add_parallelogram())
  Vec3 shoulders;       // half the difference of HalfFeatures::shoulders
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

// Sets `kind` and `clues`. Clues are values that correlate with the size of the prediction error.
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
                                     std::span<const PlacedSplit> placed) {
  const SplitRings rings(mesh, chunk, placed.size());
  const Vec3 arcs = rings.v.all.value() - rings.w.all.value();
  const NeighbourSplits around = neighbour_splits(placed, rings, arcs);
  const Predictions p = predictions_of(rings, around, arcs);

  // Factor from lattice units to cells. It is a power of two, so no rounding occurs.
  const double cells = 1.0 / static_cast<double>(1u << mesh.shift);
  SplitSurroundings out{
      .features = {p.laplacian * cells, p.arcs * cells, p.inner_arcs * cells,
                   p.parallelograms * cells, p.across_chord * cells, p.neighbours * cells,
                   p.bend * cells, p.tips * cells, p.shoulders * cells},
      .normal = rings.normal,
      .scale = rings.scale * cells};
  set_clues(out, rings, around, p);
  return out;
}

namespace {

// Returns the mean of an attribute over the half ring of v, minus its mean over the half ring of
// the new vertex.
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
