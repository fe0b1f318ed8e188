// SPDX-License-Identifier: Apache-2.0
#include "subdivided_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "codec/core/bounds.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;
constexpr int kWaves = 6;              // number of waves; each is half as long as the one before
constexpr double kLongest = 1.0 / 24;  // length of the longest wave, as a share of the diagonal
constexpr double kHeight = 1.0 / 40;   // height of a wave, as a share of its length

// Returns the unit normal of each vertex, or (0, 0, 0) for a vertex that has no normal.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3 normal =
        cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t v : {a, b, c})
      normals[v] += normal;
  }
  for (Vec3& n : normals)
    n = n * (1 / std::max(length(n), 1e-300));
  return normals;
}

template <class T>
void put(std::ostream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

// Numbers the vertices of all subdivided faces, in the order of the scan's faces.
class Numbering {
 public:
  // Cuts each edge into `n` parts.
  Numbering(const TriangleMesh& scan, std::uint32_t n) : scan_(scan), n_(n) {
    corner_.assign(scan.positions.size(), kNone);
    for (const Triangle& face : scan.faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (corner_[face[k]] == kNone) corner_[face[k]] = count_++;
        const auto [edge, is_new] = edge_.emplace(std::minmax(face[k], face[(k + 1) % 3]), count_);
        if (is_new) count_ += n - 1;
      }
      inside_.push_back(count_);
      count_ += (n - 1) * (n - 2) / 2;
    }
  }

  std::uint32_t count() const { return count_; }

  // Returns the number of point `i` in row `row` of a face. Row 0 begins at corner 0. A row begins
  // on the edge from corner 0 to corner 2 and has n - row + 1 points.
  std::uint32_t at(std::uint32_t face, std::uint32_t row, std::uint32_t i) const {
    const std::uint32_t rest = n_ - row - i;  // steps from the edge opposite to corner 0
    const auto [a, b, c] = scan_.faces[face];
    if (row == 0) return on_edge(a, b, i);
    if (i == 0) return on_edge(a, c, row);
    if (rest == 0) return on_edge(b, c, row);
    return inside_[face] + (row - 1) * (n_ - 1) - row * (row - 1) / 2 + i - 1;
  }

 private:
  std::uint32_t on_edge(std::uint32_t from, std::uint32_t to, std::uint32_t i) const {
    if (i == 0) return corner_[from];
    if (i == n_) return corner_[to];
    const std::uint32_t first = edge_.at(std::minmax(from, to));
    return first + (from < to ? i : n_ - i) - 1;
  }

  const TriangleMesh& scan_;
  std::uint32_t n_, count_ = 0;
  // Indices in the new mesh. corner_ holds the index of each vertex of the scan. edge_ and inside_
  // hold the index of the first inner point of each edge and of each face.
  std::vector<std::uint32_t> corner_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edge_;
  std::vector<std::uint32_t> inside_;
};

class Writer {
 public:
  Writer(const TriangleMesh& scan, std::uint32_t n, std::ostream& out)
      : scan_(scan), normals_(vertex_normals(scan)), n_(n), numbers_(scan, n), out_(out) {
    const Bounds bounds = bounds_of(scan.positions);
    longest_ = kLongest * length(bounds.high - bounds.low);
  }

  std::uint64_t faces() const { return scan_.faces.size() * std::uint64_t{n_} * n_; }

  void write() {
    out_ << "ply\nformat binary_little_endian 1.0\nelement vertex " << numbers_.count()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::uint32_t f = 0; f < scan_.faces.size(); ++f)
      write_vertices(f);
    for (std::uint32_t f = 0; f < scan_.faces.size(); ++f)
      write_faces(f);
  }

 private:
  // Writes the points of face `f` that belong to no earlier face, in the order of their numbers.
  void write_vertices(std::uint32_t f) {
    points_.clear();
    for (std::uint32_t row = 0; row <= n_; ++row) {
      for (std::uint32_t i = 0; i <= n_ - row; ++i) {
        const std::uint32_t number = numbers_.at(f, row, i);
        if (number >= written_) points_.push_back({number, point(f, row, i)});
      }
    }
    std::ranges::sort(points_, {}, &NumberedPoint::number);
    for (const auto& [number, p] : points_) {
      for (const double c : {p.x, p.y, p.z})
        put(out_, static_cast<float>(c));
    }
    written_ += static_cast<std::uint32_t>(points_.size());
  }

  void write_faces(std::uint32_t f) {
    for (std::uint32_t row = 0; row < n_; ++row) {
      for (std::uint32_t i = 0; i < n_ - row; ++i) {
        const std::uint32_t next = numbers_.at(f, row, i + 1), above = numbers_.at(f, row + 1, i);
        write_face({numbers_.at(f, row, i), next, above});
        if (i + 1 < n_ - row) write_face({next, numbers_.at(f, row + 1, i + 1), above});
      }
    }
  }

  void write_face(const Triangle& face) {
    put(out_, std::uint8_t{3});
    put(out_, face);
  }

  Vec3 point(std::uint32_t f, std::uint32_t row, std::uint32_t i) const {
    const auto [a, b, c] = scan_.faces[f];
    const double v = static_cast<double>(i) / n_, w = static_cast<double>(row) / n_, u = 1 - v - w;
    const auto mix = [&](const std::vector<Vec3>& of) { return of[a] * u + of[b] * v + of[c] * w; };
    const Vec3 p = mix(scan_.positions);
    return p + mix(normals_) * height(p);
  }

  double height(const Vec3& p) const {
    double sum = 0, wave = longest_;
    for (int k = 0; k < kWaves; ++k, wave /= 2) {
      const Vec3 at = p * (6.28 / wave);
      sum += wave * std::sin(at.x + k) * std::sin(at.y + 2 * k) * std::sin(at.z + 3 * k);
    }
    return kHeight * sum;
  }

  struct NumberedPoint {
    std::uint32_t number;
    Vec3 place;
  };

  const TriangleMesh& scan_;
  std::vector<Vec3> normals_;
  std::uint32_t n_;
  Numbering numbers_;
  std::ostream& out_;
  double longest_;
  std::uint32_t written_ = 0;
  std::vector<NumberedPoint> points_;  // points of the face that is being written
};

}  // namespace

std::uint64_t write_subdivided(const TriangleMesh& scan, std::uint64_t triangles,
                               std::ostream& out) {
  std::uint32_t n = 1;
  while (scan.faces.size() * std::uint64_t{n} * n < triangles)
    ++n;
  Writer writer(scan, n, out);
  writer.write();
  return writer.faces();
}

}  // namespace vitrine::bench
