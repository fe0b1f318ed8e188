// SPDX-License-Identifier: Apache-2.0
#include "codec/build/refine.h"

#include <algorithm>
#include <cmath>

#include "codec/format/cell.h"

namespace vitrine::inline codec {

Expected<void> refine(Refiner& refiner, const Want& want, const ChunkReader& read) {
  Planner planner(refiner.manifest());
  planner.want(want);
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.is_applied(i)) planner.have(i);
  }
  while (const auto chunk = planner.next()) {
    const auto bytes = read(*chunk);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto ok = refiner.apply(*chunk, *bytes); !ok) return ok;
    planner.have(*chunk);
  }
  if (const auto* w = std::get_if<WantTriangles>(&want)) {
    refiner.undo_to_faces(
        static_cast<std::uint32_t>(std::min<std::uint64_t>(w->triangles, 0xFFFF'FFFFu)));
  }
  return {};
}

ShownDetail shown_detail(const Refiner& refiner) {
  const Manifest& manifest = refiner.manifest();
  auto level = static_cast<std::uint32_t>(manifest.levels.size() - 1);
  for (std::size_t i = 0; i < manifest.chunks.size(); ++i) {
    if (!refiner.is_applied(i)) level = std::min(level, manifest.chunks[i].level - 1);
  }
  // Some splits of the last chunk may have been undone. A level without all its faces is
  // incomplete.
  while (level > 0 && manifest.levels[level].faces > refiner.face_count())
    --level;
  const bool is_whole = manifest.levels[level].faces == refiner.face_count();
  const std::size_t finest =
      std::min<std::size_t>(is_whole ? level : level + 1, manifest.levels.size() - 1);
  const std::uint32_t shift = manifest.levels[finest].shift;
  const Vec3i middle = middle_of({}, shift);
  const double offset = display_offset(shift);
  const Lattice& lattice = manifest.lattice;
  return {.level = level,
          .error = manifest.levels[level].max_error,
          .grid_origin =
              lattice.origin + (to_vec3(middle) + Vec3{offset, offset, offset}) * lattice.step,
          .grid_step = std::ldexp(lattice.step, static_cast<int>(shift))};
}

}  // namespace vitrine::inline codec
