// SPDX-License-Identifier: Apache-2.0
// Compares what two models look like, from twelve views of both through the same renderer.
#pragma once

#include <optional>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/render/textures.h"

namespace vitrine::inline codec {

// A model that is compared. `textures` is null if it has no materials.
struct ComparedModel {
  const TriangleMesh& mesh;
  const Textures* textures = nullptr;
};

struct Appearance {
  // Peak signal-to-noise ratio in decibels, over the red, green and blue of all pixels of all views
  // that either model covers (squared_error.h). Nullopt if the pictures are equal.
  std::optional<double> psnr;
  // Mean over the views of the structural similarity index of their luma (structural_similarity.h),
  // at most 1. Views that neither model covers do not count.
  double ssim = 1;
};

// Renders both models in the views of the reference `b` (views.h) over grey (backdrop.h), with the
// light and the matt surfaces of codec/render and the same normals at vertices of the same
// position. A part of `a` outside these views is cut off, so exchanging the models gives other
// figures unless their bounding spheres are equal.
//
// Fails (kBadInput) if a mesh has no face, a face index is out of range, or no pixel can be
// compared.
Expected<Appearance> compare_appearance(const ComparedModel& a, const ComparedModel& b);

}  // namespace vitrine::inline codec
