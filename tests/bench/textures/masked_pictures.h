// SPDX-License-Identifier: Apache-2.0
// The pictures of a source model as WebP files, as the compared file formats store them.
#pragma once

#include <cstdint>
#include <vector>

#include "textured_model.h"

namespace vitrine::bench {

// Quality with which the pictures are written as WebP files.
inline constexpr int kPictureQuality = 80;
// Smallest side, in pixels, of a picture for the compared file formats.
inline constexpr std::uint32_t kLeastSide = 256;

struct SizedPicture {
  std::uint32_t side = 0;  // width and height in pixels
  std::vector<std::uint8_t> file;
};

// Returns picture number `picture` of a model, and smaller versions down to kLeastSide, the
// smallest first. Each has half the side of the next. Texels outside all charts are filled
// smoothly, as in the pictures of a .pmesh. Fails if the picture is not square.
std::vector<SizedPicture> masked_pictures(const TexturedModel& model, std::uint32_t picture);

// Returns picture number `picture` of a model, unchanged.
std::vector<std::uint8_t> unmasked_picture(const TexturedModel& model, std::uint32_t picture);

// Returns the numbers of the pictures that some material uses as one of `maps`.
std::vector<std::uint32_t> used_pictures(const Texturing& texturing,
                                         std::span<const MapOfMaterial> maps);

}  // namespace vitrine::bench
