// SPDX-License-Identifier: Apache-2.0
// Converts tangent-space normals of a face between the frames of two sets of texture coordinates.
#pragma once

#include <array>
#include <cmath>

#include "codec/core/vec2.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The tangent and the bitangent of a face: the directions in which its texture coordinates grow, in
// the plane of the face. The bitangent points up in the picture. Both are scaled so that the longer
// one has length 1.
class TangentFrame {
 public:
  // `ab` and `ac` are two edges of the face, as vectors in its plane. `u` and `v` hold the
  // differences of the two texture coordinates along `ab` and `ac`.
  TangentFrame(const Vec2& ab, const Vec2& ac, const Vec2& u, const Vec2& v) {
    const double area = cross(ab, ac);
    const double inverse = area != 0 ? 1 / area : 0;
    tangent_ = Vec2{u.x * ac.y - u.y * ab.y, u.y * ab.x - u.x * ac.x} * inverse;
    bitangent_ = Vec2{v.x * ac.y - v.y * ab.y, v.y * ab.x - v.x * ac.x} * -inverse;
    const double longest =
        std::sqrt(std::max(dot(tangent_, tangent_), dot(bitangent_, bitangent_)));
    const double scale = longest > 0 ? 1 / longest : 0;
    tangent_ = tangent_ * scale, bitangent_ = bitangent_ * scale;
  }

  Vec2 to_plane(const Vec2& p) const { return tangent_ * p.x + bitangent_ * p.y; }
  Vec2 from_plane(const Vec2& p) const {
    const double area = cross(tangent_, bitangent_);
    const double inverse = area != 0 ? 1 / area : 0;
    return Vec2{cross(p, bitangent_), cross(tangent_, p)} * inverse;
  }

 private:
  Vec2 tangent_, bitangent_;
};

class TangentTurn {
 public:
  TangentTurn(const TriangleMesh& mesh, const Triangle& face,
              const std::array<TextureCoordinates, 3>& from, const std::array<Vec2, 3>& to)
      : TangentTurn(mesh.positions[face[1]] - mesh.positions[face[0]],
                    mesh.positions[face[2]] - mesh.positions[face[0]], from, to) {}

  // Converts the in-plane part of a normal from one frame to the other. In the picture, x points
  // right and y points up.
  Vec2 operator()(const Vec2& across) const { return to_.from_plane(from_.to_plane(across)); }

 private:
  TangentTurn(const Vec3& ab, const Vec3& ac, const std::array<TextureCoordinates, 3>& from,
              const std::array<Vec2, 3>& to)
      : TangentTurn(Vec2{length(ab), 0}, in_plane(ab, ac), from, to) {}
  TangentTurn(const Vec2& ab, const Vec2& ac, const std::array<TextureCoordinates, 3>& from,
              const std::array<Vec2, 3>& to)
      : from_(ab, ac, {double{from[1][0]} - from[0][0], double{from[2][0]} - from[0][0]},
              {double{from[1][1]} - from[0][1], double{from[2][1]} - from[0][1]}),
        to_(ab, ac, {to[1].x - to[0].x, to[2].x - to[0].x},
            {to[1].y - to[0].y, to[2].y - to[0].y}) {}

  static Vec2 in_plane(const Vec3& ab, const Vec3& ac) {
    const double side = length(ab);
    return side > 0 ? Vec2{dot(ab, ac) / side, length(cross(ab, ac)) / side} : Vec2{};
  }

  TangentFrame from_, to_;
};

}  // namespace vitrine::inline codec
