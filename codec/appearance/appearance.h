// SPDX-License-Identifier: Apache-2.0
// Compares how two models look. Both are rendered from the same twelve directions.
#pragma once

#include <array>
#include <optional>

#include "codec/appearance/views.h"
#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/picture/picture.h"
#include "codec/render/textures.h"

namespace vitrine::inline codec {

// A model to compare. `textures` is null if the model has no materials.
struct ComparedModel {
  const TriangleMesh& mesh;
  const Textures* textures = nullptr;
};

struct Appearance {
  // Peak signal-to-noise ratio (squared_error.h) in decibels, over all pixels of all views that
  // show at least one of the models. Nullopt if the pictures are equal.
  std::optional<double> psnr;
  // Structural similarity index of the luma (structural_similarity.h), at most 1. This is the mean
  // over all views that show at least one of the models.
  double ssim = 1;
};

// The pictures of one model, rendered once and compared with the pictures of several other models.
class AppearanceReference {
 public:
  // Fails (kBadInput) if the mesh has no face or no extent, or a face index is out of range.
  static Expected<AppearanceReference> of(const ComparedModel& model);

  // Returns what compare_appearance() returns for `model` and the model of this reference.
  Expected<Appearance> compare(const ComparedModel& model) const;

 private:
  std::array<Framing, kViews> views_;
  std::array<Picture, kViews> pictures_;
};

// Renders both models in the views around the reference `b` (views.h), on a grey background
// (backdrop.h), and compares the pictures. Both models get the same light and matt surfaces
// (codec/render). Vertices at the same position get the same normal.
//
// Parts of `a` outside these views are cut off. Swapping the models therefore changes the result,
// unless their bounding spheres are equal.
//
// Fails (kBadInput) if a mesh has no face, a face index is out of range, or no pixel can be
// compared.
Expected<Appearance> compare_appearance(const ComparedModel& a, const ComparedModel& b);

}  // namespace vitrine::inline codec
