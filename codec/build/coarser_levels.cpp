// SPDX-License-Identifier: Apache-2.0
#include "codec/build/coarser_levels.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

CoarserLevel shown_level(const Refiner& refiner, bool is_textured) {
  const ShownDetail detail = shown_detail(refiner);
  CoarserLevel level{.mesh = refiner.display_mesh(),
                     .coordinates = {},
                     .level = detail.level,
                     .error = detail.error,
                     .grid = {detail.grid_origin, detail.grid_step}};
  if (is_textured) {
    level.mesh.attributes.colours.clear();
    level.coordinates = refiner.texture_coordinates();
  }
  return level;
}

}  // namespace

std::vector<std::uint32_t> coarser_levels(const Manifest& manifest, std::uint32_t finest,
                                          std::uint64_t faces) {
  constexpr std::uint64_t kFactor = 4;
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t level = finest + 1; level-- > 0;) {
    const std::uint64_t own = manifest.levels[level].faces;
    if (own * kFactor > faces && (level > 0 || own >= faces)) continue;
    chosen.push_back(level);
    faces = own;
  }
  return chosen;
}

Expected<std::vector<CoarserLevel>> decode_levels(Refiner refiner,
                                                  std::span<const std::uint32_t> levels,
                                                  bool is_textured, const ChunkReader& read) {
  std::vector<CoarserLevel> decoded;
  for (std::size_t i = levels.size(); i-- > 0;) {
    if (auto ok = refine(refiner, WantLevel{levels[i]}, read); !ok)
      return tl::unexpected(ok.error());
    decoded.push_back(shown_level(refiner, is_textured));
  }
  std::ranges::reverse(decoded);
  return decoded;
}

}  // namespace vitrine::inline codec
