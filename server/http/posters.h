// SPDX-License-Identifier: Apache-2.0
// The sizes of a model's poster: a square picture, transparent around the model.
#pragma once

namespace vitrine {

inline constexpr unsigned kPosterWidths[] = {240, 480, 960};
inline constexpr unsigned kPosterWidth = 480;  // where nothing is said
inline constexpr unsigned kThumbnailWidth = 240, kCanvasWidth = 960;

}  // namespace vitrine
