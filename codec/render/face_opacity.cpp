// SPDX-License-Identifier: Apache-2.0
#include "codec/render/face_opacity.h"

namespace vitrine::inline codec {
namespace {

// Returns the smallest opacity at which this sample is visible. The thresholds are ordered such
// that the visible samples of a pixel are evenly spread.
double screen_door(SamplePosition at) {
  constexpr int kOrder[kSamples][kSamples] = {{0, 7, 3}, {6, 5, 2}, {4, 1, 8}};
  return (kOrder[at.y % kSamples][at.x % kSamples] + 0.5) / (kSamples * kSamples);
}

}  // namespace

bool FaceOpacity::operator()(const Barycentric& weights, SamplePosition at) const {
  if (material_->alpha_mode == AlphaMode::kOpaque) return true;
  const double map = base_colour_ ? base_colour_->at(weights)[3] : 1;
  const bool is_mask = material_->alpha_mode == AlphaMode::kMask;
  return material_->base_colour[3] * map >= (is_mask ? material_->alpha_cutoff : screen_door(at));
}

}  // namespace vitrine::inline codec
