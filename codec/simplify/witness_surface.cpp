// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/witness_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/mesh/face_neighbours.h"

namespace vitrine {
namespace {

constexpr int kMaxSteps = 64;         // of a walk
constexpr double kFloatError = 1e-6;  // of products with a frame, against the other factor
constexpr double kMuch = 100;

Vec3 widen(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

std::array<float, 3> narrow(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double product(const std::array<float, 3>& a, const Vec3& b) {
  return a[0] * b.x + a[1] * b.y + a[2] * b.z;
}

}  // namespace

WitnessSurface::WitnessSurface(const TriangleBvh& bvh, const TriangleMesh& mesh) : bvh_(&bvh) {
  std::vector<Triangle> faces;
  faces.reserve(mesh.faces.size());
  for (std::uint32_t t = 0; t < mesh.faces.size(); ++t)
    faces.push_back(mesh.faces[bvh.face(t)]);
  across_ = face_neighbours(faces, mesh.positions.size());
  make_frames();
}

WitnessSurface::WitnessSurface(const TriangleBvh& bvh, const WitnessSurface& shape)
    : bvh_(&bvh), across_(shape.across_) {
  make_frames();
}

void WitnessSurface::make_frames() {
  frames_.reserve(bvh_->triangles().size());
  for (const Corners& t : bvh_->triangles())
    frames_.push_back(make_frame(t));
}

WitnessSurface::Frame WitnessSurface::make_frame(const Corners& t) {
  const Vec3 normal = cross(t.b - t.a, t.c - t.a);
  const double size = length(normal);
  if (!(size > 0)) {
    const float none = std::numeric_limits<float>::quiet_NaN();
    return {{none, none, none}, {}};
  }
  const Vec3 unit = normal * (1 / size);
  Frame frame{narrow(unit), {}};
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vec3 inward = cross(unit, corner(t, (k + 1) % 3) - corner(t, k));
    frame.inward[k] = narrow(inward * (1 / length(inward)));
  }
  return frame;
}

double WitnessSurface::distance(const Vec3& p, std::uint32_t t) const {
  const Corners& triangle = bvh_->triangles()[t];
  const Frame& frame = frames_[t];
  const Vec3 from_a = p - triangle.a;
  const double height = std::abs(product(frame.normal, from_a));
  const double error = kFloatError * (std::abs(from_a.x) + std::abs(from_a.y) + std::abs(from_a.z));
  // Not so where the height is not a number.
  const bool quick = height > kMuch * error && product(frame.inward[0], from_a) >= 0 &&
                     product(frame.inward[1], p - triangle.b) >= 0 &&
                     product(frame.inward[2], from_a) >= 0;
  return quick ? height + error : std::sqrt(squared_distance(triangle, p));
}

double WitnessSurface::distance_within(const Vec3& p, std::uint32_t t, double most) const {
  const Corners& triangle = bvh_->triangles()[t];
  const Frame& frame = frames_[t];
  const Vec3 from_a = p - triangle.a;
  const bool far =
      std::abs(product(frame.normal, from_a)) > most || product(frame.inward[0], from_a) < -most ||
      product(frame.inward[2], from_a) < -most || product(frame.inward[1], p - triangle.b) < -most;
  return far ? std::numeric_limits<double>::infinity() : distance(p, t);
}

std::array<double, 3> WitnessSurface::overhang(const Vec3& p, std::uint32_t t) const {
  const Corners& triangle = bvh_->triangles()[t];
  const Frame& frame = frames_[t];
  return {-product(frame.inward[0], p - triangle.a), -product(frame.inward[1], p - triangle.b),
          -product(frame.inward[2], p - triangle.c)};
}

WitnessSurface::Plane WitnessSurface::bisector(std::uint32_t t, std::uint32_t edge) const {
  const std::uint32_t other = across(t, edge), back = edge_across(t, edge);
  const Vec3 normal = widen(frames_[t].inward[edge]) - widen(frames_[other].inward[back]);
  const double size = length(normal);
  return {corner(triangle(t), edge), size > 0 ? normal * (1 / size) : Vec3{}};
}

std::uint32_t WitnessSurface::stroll(const Vec3& p, std::uint32_t start) const {
  std::uint32_t at = start, before = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::array<double, 3> beyond = overhang(p, at);
    const auto most = std::max_element(beyond.begin(), beyond.end());
    if (!(*most > 0)) break;
    const std::uint32_t next = across(at, static_cast<std::uint32_t>(most - beyond.begin()));
    if (next == before || next == at) break;
    before = at, at = next;
  }
  return at;
}

std::uint32_t WitnessSurface::walk(const Vec3& p, std::uint32_t start) const {
  std::uint32_t best = start, before = start;
  double squared = squared_distance(triangle(start), p);
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::uint32_t from = best;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t t = across(from, k);
      if (t == before || t == from) continue;
      const double other = squared_distance(triangle(t), p);
      if (other < squared) squared = other, best = t;
    }
    if (best == from) break;
    before = from;
  }
  return best;
}

SurfacePoint WitnessSurface::closest(const Vec3& p, std::uint32_t hint) const {
  return bvh_->closest(p, {squared_distance(triangle(hint), p), hint});
}

}  // namespace vitrine
