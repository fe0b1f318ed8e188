// SPDX-License-Identifier: Apache-2.0
#include "codec/build/refine.h"

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

}  // namespace vitrine::inline codec
