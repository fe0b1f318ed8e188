// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/hausdorff_bound.h"

#include <algorithm>
#include <cmath>

namespace vitrine {
namespace {

constexpr int kMaxSteps = 64;  // of a walk
// A piece is halved at once where radius^4 exceeds this many times (twice the witness' area)^2.
constexpr double kManyWitnesses = 16;
constexpr double kSlack = 1e-6;  // of the limit: what a cut may leave standing

std::array<Vec3, 3> in_order(const Corners& t) {
  return {t.a, t.b, t.c};
}

Vec3 centre_of(const Corners& t) {
  return (t.a + t.b + t.c) * (1.0 / 3);
}

}  // namespace

WitnessSurface::WitnessSurface(const TriangleBvh& bvh, const TriangleMesh& mesh) : bvh_(&bvh) {
  std::vector<Triangle> faces;
  faces.reserve(mesh.faces.size());
  for (std::uint32_t t = 0; t < mesh.faces.size(); ++t)
    faces.push_back(mesh.faces[bvh.face(t)]);
  across_ = face_neighbours(faces, mesh.positions.size());
}

std::uint32_t WitnessSurface::walk(const Vec3& p, std::uint32_t start) const {
  std::uint32_t best = start, before = start;
  double squared = squared_distance(triangle(start), p);
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::uint32_t from = best;
    for (std::uint32_t t : across_[from]) {
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

void HausdorffBound::add(const TriangleBvh& source, const WitnessSurface& target) {
  target_ = &target;
  last_ = 0;
  visit(source, 0);
}

void HausdorffBound::visit(const TriangleBvh& source, std::uint32_t index) {
  const TriangleBvh::Node& node = source.nodes()[index];
  if (settle_box(node)) return;
  if (node.count == 0) {
    visit(source, node.first);
    visit(source, node.first + 1);
    return;
  }
  const auto triangles = source.triangles().subspan(node.first, node.count);
  last_ = target_->closest(centre_of(triangles[0]), last_).triangle;
  for (const Corners& t : triangles)
    visit_triangle(t);
}

void HausdorffBound::visit_triangle(const Corners& triangle) {
  if (!settle(in_order(triangle), last_)) refine(ConvexPiece(triangle), last_);
}

// True if one witness serves the whole box.
bool HausdorffBound::settle_box(const TriangleBvh::Node& n) {
  const Vec3 low{n.low[0], n.low[1], n.low[2]}, high{n.high[0], n.high[1], n.high[2]};
  if (length(high - low) > limit()) return false;
  last_ = target_->closest((low + high) * 0.5, last_).triangle;
  std::array<Vec3, 8> corners;
  for (unsigned k = 0; k < 8; ++k) {
    corners[k] = {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
  }
  return settle(corners, last_);
}

bool HausdorffBound::settle(std::span<const Vec3> corners, std::uint32_t witness) {
  const double most = limit() * limit();
  double squared = 0;
  for (const Vec3& p : corners) {
    squared = std::max(squared, squared_distance(target_->triangle(witness), p));
    if (squared > most) return false;
  }
  bound_ = std::max(bound_, std::sqrt(squared));
  return true;
}

// `cuts` more cuts may follow before the piece is halved: rounding must not let them go on for
// ever.
void HausdorffBound::refine(const ConvexPiece& piece, std::uint32_t start, int cuts) {
  const Vec3 centre = piece.centre();
  const std::uint32_t witness = last_ = target_->walk(centre, start);
  if (settle(piece.corners(), witness)) return;
  const std::array<Vec3, 3> p = in_order(target_->triangle(witness));
  const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
  const double size = dot(normal, normal), radius = piece.radius(centre);
  if (size > 0 && radius * radius * radius * radius > kManyWitnesses * size) {
    halve(piece, witness);
  } else if (size == 0 || cuts == 0 || !cut_along(piece, witness, cuts - 1)) {
    examine(piece, witness);
  }
}

// Cuts off what lies beyond the edges of the witness, seen along its normal. False, and nothing
// done, if that is nothing or everything.
bool HausdorffBound::cut_along(const ConvexPiece& piece, std::uint32_t witness, int cuts) {
  if (piece.full()) return false;
  const std::array<Vec3, 3> p = in_order(target_->triangle(witness));
  const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
  ConvexPiece rest = piece;
  std::array<ConvexPiece, 3> beyond;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vec3 inwards = cross(normal, p[(k + 1) % 3] - p[k]);
    ConvexPiece::Cut parts = rest.cut(p[k], inwards * (1 / length(inwards)), kSlack * limit());
    if (parts.front.empty()) return false;
    beyond[k] = parts.back, rest = parts.front;
  }
  if (beyond[0].empty() && beyond[1].empty() && beyond[2].empty()) return false;
  if (!settle(rest.corners(), witness)) examine(rest, witness);
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (!beyond[k].empty()) refine(beyond[k], target_->across(witness, k), cuts);
  }
  return true;
}

// Where no witness near by is good enough, true distances decide.
void HausdorffBound::examine(const ConvexPiece& piece, std::uint32_t witness) {
  for (const Vec3& p : piece.corners()) {
    if (squared_distance(target_->triangle(witness), p) <= known_ * known_) continue;
    know(std::sqrt(target_->closest(p, witness).squared));
  }
  const Vec3 centre = piece.centre();
  const SurfacePoint middle = target_->closest(centre, witness);
  know(std::sqrt(middle.squared));
  if (settle(piece.corners(), middle.triangle)) return;
  // The distance grows no faster than one moves.
  const double reach = std::sqrt(middle.squared) + piece.radius(centre);
  if (reach > limit()) return halve(piece, middle.triangle);
  bound_ = std::max(bound_, reach);
}

void HausdorffBound::halve(const ConvexPiece& piece, std::uint32_t start) {
  const ConvexPiece::Cut parts = piece.halves();
  if (!parts.front.empty()) refine(parts.front, start);
  if (!parts.back.empty()) refine(parts.back, start);
}

}  // namespace vitrine
