// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/wedge_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "codec/core/exact_math.h"
#include "codec/mesh/symmetric_dirichlet.h"

namespace vitrine::inline codec {
namespace {

constexpr int kSweeps = 3;  // rounds of relaxation
// smallest accepted shape() of a triangle
constexpr double kGoodShape = 1e-3;

// A wedge at a split's vertices: its coordinates before the split, and the parts of it that v and w
// get. A part is kNoWedge if the vertex gets no part.
struct Parted {
  WedgeId at_v = kNoWedge, at_w = kNoWedge;
  Vec2i before;
};

Vec2i rounded(const Vec2& p) {
  return {exact::round(p.x), exact::round(p.y)};
}

// A corner at a vertex that is split or moved, and the wedges of the three corners of its face,
// starting with this corner. All wedges are kNoWedge if the face closes a boundary loop.
struct Spoke {
  Corner corner;
  WedgeId wedge, next, prev;
  bool is_real() const { return wedge != kNoWedge; }
};

// Appends the corners at v in ring order, counter-clockwise. The `prev` vertex of each corner is
// the `next` vertex of the following corner.
void append_spokes(const MeshState& mesh, VertexId v, std::vector<Spoke>& spokes) {
  const Corner first = mesh.connectivity.corner_at(v);
  Corner c = first;
  do {
    spokes.push_back({c, mesh.wedges.of(c), mesh.wedges.of(next(c)), mesh.wedges.of(prev(c))});
    c = mesh.connectivity.swing(c);
  } while (c != first);
}

// The linear map from space to the picture that fits the triangles around a vertex best, by least
// squares.
class LinearMap {
 public:
  // Adds a point near the vertex. `d` is the vector from the vertex to the point in space. `e` is
  // this vector in the picture.
  void add(const Vec3& d, const Vec2& e) {
    xx_ += d.x * d.x, xy_ += d.x * d.y, xz_ += d.x * d.z;
    yy_ += d.y * d.y, yz_ += d.y * d.z, zz_ += d.z * d.z;
    u_ += d * e.x, v_ += d * e.y;
  }

  // Solves for the map. The term added to the diagonal keeps the map small along the surface
  // normal, because points near the vertex hardly determine the map in this direction.
  void solve() {
    const double term = 0.003 * (xx_ + yy_ + zz_) + 1e-9;
    xx_ += term, yy_ += term, zz_ += term;
    const Vec3 x = {yy_ * zz_ - yz_ * yz_, xz_ * yz_ - xy_ * zz_, xy_ * yz_ - xz_ * yy_};
    const Vec3 y = {x.y, xx_ * zz_ - xz_ * xz_, xz_ * xy_ - xx_ * yz_};
    const Vec3 z = {x.z, y.z, xx_ * yy_ - xy_ * xy_};
    const double det = xx_ * x.x + xy_ * x.y + xz_ * x.z;
    const double inverse = det > 0 ? 1 / det : 0;
    u_ = Vec3{dot(x, u_), dot(y, u_), dot(z, u_)} * inverse;
    v_ = Vec3{dot(x, v_), dot(y, v_), dot(z, v_)} * inverse;
  }

  Vec2 operator()(const Vec3& d) const { return {dot(u_, d), dot(v_, d)}; }

 private:
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  Vec3 u_, v_;
};

// Places the wedges of one split.
class SplitPlacement {
 public:
  SplitPlacement(MeshState& mesh, VertexId v, VertexId w, const Vec3i& merged)
      : mesh_(mesh), v_(v), w_(w), merged_(merged), region_(mesh.vertex[v].region) {
    spokes_.reserve(kSpokes);
    append_spokes(mesh, v, spokes_);
    first_of_w_ = spokes_.size();
    append_spokes(mesh, w, spokes_);
  }

  void place_all() {
    for (const Parted& parts : parted_wedges())
      place(parts);
  }

 private:
  static constexpr std::size_t kSpokes = 32;  // usual maximum number of spokes at v and w together

  // Returns all wedges at v and w. The two parts of a wedge that the split has divided form one
  // entry.
  std::vector<Parted> parted_wedges() const {
    std::vector<Parted> out;
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
      const WedgeId part = spokes_[i].wedge;
      if (!spokes_[i].is_real() || is_part_of(out, part)) continue;
      const WedgeId whole = i < first_of_w_ ? part : mesh_.wedges.whole(part);
      const auto same = std::find_if(out.begin(), out.end(),
                                     [&](const Parted& parts) { return parts.at_v == whole; });
      if (i < first_of_w_) {
        out.push_back({.at_v = part, .before = mesh_.wedges[part].at});
      } else if (same != out.end()) {
        same->at_w = part;
      } else {
        out.push_back({.at_w = part, .before = mesh_.wedges[part].at});
      }
    }
    return out;
  }
  static bool is_part_of(const std::vector<Parted>& list, WedgeId part) {
    return std::any_of(list.begin(), list.end(), [part](const Parted& parts) {
      return parts.at_v == part || parts.at_w == part;
    });
  }

  void place(const Parted& parts) {
    parts_ = parts;
    measure();
    if (area_ <= 0) return;
    map_.solve();
    best_shape_ = -2;  // below the shape of any triangle
    if (along_displacement() || along_directions()) return;
    set(best_v_, best_w_);
  }

  bool is_new(Corner c) const { return c / 3 + 2 >= mesh_.connectivity.face_count(); }

  // Calls visit(spoke) for each corner of the wedges that are being placed.
  template <class Visit>
  void for_each_spoke(Visit visit) const {
    for (const Spoke& spoke : spokes_) {
      if (!spoke.is_real()) continue;
      if (spoke.wedge == parts_.at_v || spoke.wedge == parts_.at_w) visit(spoke);
    }
  }

  // Computes area_ from the triangles that were around the vertex before the split, and adds their
  // corners to map_.
  void measure() {
    map_ = {};
    area_ = 0;
    for_each_spoke([&](const Spoke& spoke) {
      if (is_new(spoke.corner)) return;
      map_.add(to_vec3(position(next(spoke.corner)) - merged_), to_vec2(uv(spoke.next)));
      map_.add(to_vec3(position(prev(spoke.corner)) - merged_), to_vec2(uv(spoke.prev)));
      area_ += std::abs(cross(to_vec2(uv(spoke.next)), to_vec2(uv(spoke.prev))));
    });
  }

  Vec3i position(Corner c) const { return mesh_.seen_from(region_, mesh_.connectivity.vertex(c)); }
  // Returns the coordinates of a wedge, relative to the coordinates of the divided wedge before the
  // split.
  Vec2i uv(WedgeId wedge) const { return mesh_.wedges[wedge].at - parts_.before; }

  // Returns the worst shape of the triangles at both wedges. The shape of a triangle is twice its
  // area divided by the square of its longest edge.
  double shape() const {
    double least = 1;
    for_each_spoke([&](const Spoke& spoke) {
      const Vec2i at = uv(spoke.wedge);
      const Vec2 a = to_vec2(uv(spoke.next) - at), b = to_vec2(uv(spoke.prev) - at);
      const Vec2 across = b - a;
      const double longest = std::max({dot(a, a), dot(b, b), dot(across, across), 1e-9});
      least = std::min(least, cross(a, b) / longest);
    });
    return least;
  }

  void set(const Vec2i& at_v, const Vec2i& at_w) {
    if (parts_.at_v != kNoWedge) mesh_.wedges.move(parts_.at_v, at_v);
    if (parts_.at_w != kNoWedge) mesh_.wedges.move(parts_.at_w, at_w);
  }

  // Tries to move the two wedges by `to_v` and `to_w`. Returns whether all triangles then have a
  // good shape().
  bool attempt(const Vec2& to_v, const Vec2& to_w) {
    const Vec2i at_v = parts_.before + rounded(to_v), at_w = parts_.before + rounded(to_w);
    set(at_v, at_w);
    const double now = shape();
    if (now > best_shape_) best_shape_ = now, best_v_ = at_v, best_w_ = at_w;
    return now > kGoodShape;
  }

  bool along_displacement() {
    const Vec2 to_v = map_(to_vec3(mesh_.positions[v_] - merged_));
    const Vec2 to_w = map_(to_vec3(mesh_.positions[w_] - merged_));
    double share = 1;
    for (int trial = 0; trial < 6; ++trial, share *= 0.5) {
      if (attempt(to_v * share, to_w * share)) return true;
    }
    return false;
  }

  // Tries sixteen directions, each at three distances.
  bool along_directions() {
    constexpr double kHalf = 0.9238795325112867, kDiagonal = 0.7071067811865476,
                     kSmall = 0.3826834323650898;
    constexpr std::array<Vec2, 4> kQuarter = {
        {{1, 0}, {kHalf, kSmall}, {kDiagonal, kDiagonal}, {kSmall, kHalf}}};
    double radius = std::sqrt(area_ * 0.5) * 0.25;
    for (int ring = 0; ring < 3; ++ring, radius *= 0.4) {
      for (Vec2 d : kQuarter) {
        for (int turn = 0; turn < 4; ++turn, d = {-d.y, d.x}) {
          if (attempt(d * radius, d * -radius)) return true;
        }
      }
    }
    return false;
  }

  MeshState& mesh_;
  VertexId v_, w_;
  Vec3i merged_;
  std::uint16_t region_;
  std::vector<Spoke> spokes_;   // corners at v, then corners at w
  std::size_t first_of_w_ = 0;  // index in spokes_ of the first corner at w
  Parted parts_;
  LinearMap map_;
  double area_ = 0;  // twice the area, in the picture, of the triangles before the split
  double best_shape_ = 0;
  Vec2i best_v_, best_w_;
};

// Improves the wedges of a chunk's splits, one block of splits after another. The triangles of a
// block are collected once for all sweeps. Blocks are small, so that their triangles stay in the
// processor's cache.
class Relaxation {
 public:
  Relaxation(MeshState& mesh, const ChunkSplits& chunk) : mesh_(mesh), chunk_(chunk) {}

  void run() {
    for (std::size_t first = 0; first < chunk_.size(); first += kBlock) {
      collect(first, std::min(first + kBlock, chunk_.size()));
      for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const Star& star : stars_)
          relax(star);
      }
    }
  }

 private:
  static constexpr std::size_t kBlock = 256;  // number of splits per block

  // A triangle that has a corner in a wedge: the wedges of its other two corners, and its shape in
  // space.
  struct StarTriangle {
    WedgeId next, prev;
    TriangleShape shape;
  };
  // A wedge and its triangles, which have the indices `begin` to `end` - 1.
  struct Star {
    WedgeId wedge;
    std::size_t begin, end;
  };

  // Collects the stars of all wedges at the vertices of the splits from `first` to `last` - 1.
  void collect(std::size_t first, std::size_t last) {
    stars_.clear();
    triangles_.clear();
    for (std::size_t s = first; s < last; ++s) {
      collect_vertex(chunk_.v(s));
      collect_vertex(chunk_.w(s));
    }
  }

  void collect_vertex(VertexId v) {
    spokes_.clear();
    append_spokes(mesh_, v, spokes_);
    find_edges(v);
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
      if (spokes_[i].is_real() && is_first(i)) collect_star(i);
    }
  }

  // Stores in edges_ the vectors from v to its ring vertices, in space. The vector to a virtual
  // vertex is zero.
  void find_edges(VertexId v) {
    edges_.clear();
    const Vec3i centre = mesh_.positions[v];
    const std::uint16_t region = mesh_.vertex[v].region;
    for (const Spoke& spoke : spokes_) {
      const VertexId q = mesh_.connectivity.neighbour(spoke.corner);
      edges_.push_back(is_virtual(q) ? Vec3{} : to_vec3(mesh_.seen_from(region, q) - centre));
    }
  }

  // Returns whether spoke i is the first spoke with its wedge.
  bool is_first(std::size_t i) const {
    return std::none_of(spokes_.begin(), spokes_.begin() + static_cast<std::ptrdiff_t>(i),
                        [&](const Spoke& other) { return other.wedge == spokes_[i].wedge; });
  }

  // Collects a wedge and its triangles as a Star. `first` is the index of the wedge's first spoke.
  void collect_star(std::size_t first) {
    Star star{.wedge = spokes_[first].wedge, .begin = triangles_.size(), .end = 0};
    for (std::size_t i = first; i < spokes_.size(); ++i) {
      if (spokes_[i].wedge != star.wedge) continue;
      const Vec3& to_prev = edges_[i + 1 == spokes_.size() ? 0 : i + 1];
      triangles_.push_back({spokes_[i].next, spokes_[i].prev, {edges_[i], to_prev}});
    }
    star.end = triangles_.size();
    stars_.push_back(star);
  }

  void relax(const Star& star) {
    const Vec2i centre = mesh_.wedges[star.wedge].at;
    energies_.clear();
    for (std::size_t i = star.begin; i < star.end; ++i) {
      const StarTriangle& t = triangles_[i];
      energies_.emplace_back(to_vec2(mesh_.wedges[t.next].at - centre),
                             to_vec2(mesh_.wedges[t.prev].at - centre), t.shape);
    }
    const double scale = area_ratio({}, energies_);
    if (scale > 0) mesh_.wedges.move(star.wedge, centre + rounded(relaxed({}, scale, energies_)));
  }

  MeshState& mesh_;
  const ChunkSplits& chunk_;
  std::vector<Spoke> spokes_;             // spokes of the vertex whose stars are being collected
  std::vector<Vec3> edges_;               // per spoke: the vector in space to its next vertex
  std::vector<Star> stars_;               // stars of the block, in the order of improvement
  std::vector<StarTriangle> triangles_;   // triangles of all stars
  std::vector<EnergyTriangle> energies_;  // energies of the star that is being improved
};

}  // namespace

void place_wedges(MeshState& mesh, VertexId v, VertexId w, const Vec3i& merged) {
  SplitPlacement(mesh, v, w, merged).place_all();
}

void relax_wedges(MeshState& mesh, const ChunkSplits& chunk) {
  Relaxation(mesh, chunk).run();
}

}  // namespace vitrine::inline codec
