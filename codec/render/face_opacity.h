// SPDX-License-Identifier: Apache-2.0
// Decides at which samples a partly transparent face is visible.
#pragma once

#include <optional>

#include "codec/render/canvas.h"
#include "codec/render/textures.h"

namespace vitrine::inline codec {

// With AlphaMode::kMask, a sample is visible if its opacity is at least the cutoff. With
// AlphaMode::kBlend, the face is visible at a share of a pixel's samples (screen-door
// transparency). This share equals the opacity, rounded to a multiple of 1 / kSamples^2. Unlike
// blending, this does not require faces to be sorted by depth.
class FaceOpacity {
 public:
  // `material` must outlive this object.
  FaceOpacity(const Material& material, const std::optional<FaceTexture>& base_colour)
      : material_(&material), base_colour_(base_colour) {}

  // Whether a sample is visible.
  bool operator()(const Barycentric& weights, SamplePosition at) const;

 private:
  const Material* material_;
  std::optional<FaceTexture> base_colour_;
};

}  // namespace vitrine::inline codec
