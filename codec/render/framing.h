// SPDX-License-Identifier: Apache-2.0
// Parallel projections of a model: the direction to the eye, and the visible part of the model.
#pragma once

#include <cstdint>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The visible part of the model, and the size of the picture.
struct Framing {
  Vec3 centre;                          // the point in the middle of the picture, model units
  double pixel = 1;                     // width of a pixel in model units, > 0
  std::uint32_t width = 1, height = 1;  // size in pixels, each >= 1
  // Direction from the model to the eye; neither 0 nor vertical. The default is the initial view of
  // the viewer page.
  Vec3 toward = {0.35, 0.15, 1};
};

// The axes of a view in model space: to the right, up in the picture, and towards the eye. They are
// orthonormal. The model's y axis points up in the picture.
class ViewAxes {
 public:
  explicit ViewAxes(const Vec3& toward);

  Vec3 to_view(const Vec3& v) const { return {dot(v, right_), dot(v, up_), dot(v, toward_)}; }
  Vec3 to_model(const Vec3& v) const { return right_ * v.x + up_ * v.y + toward_ * v.z; }

 private:
  Vec3 toward_, right_, up_;
};

// Returns a framing that shows all of `mesh` from the direction `toward`, with a narrow margin. The
// longer side of the picture has `longest` pixels, the other side at least half as many.
Framing frame_around(const TriangleMesh& mesh, std::uint32_t longest,
                     const Vec3& toward = Framing{}.toward);

}  // namespace vitrine::inline codec
