// SPDX-License-Identifier: Apache-2.0
#include "server/store/model_file.h"

#include <algorithm>

#include "codec/format/manifest.h"

namespace vitrine::server {
namespace {

// Removes the levels finer than `last_level` and their chunks. If it removes any, also removes the
// pictures after the chunks. Always removes the optional blocks, such as the source's pictures.
// Positions of merged vertices are rounded down and up alternately, level by level, counted from
// the finest (FORMAT.md, section 5). Therefore removes an even number of levels: if the requested
// number is odd, removes one level more, but never the base mesh.
void cut(Manifest& manifest, std::uint32_t last_level) {
  const std::size_t all = manifest.levels.size();
  std::size_t levels = std::min<std::size_t>(last_level + 1ull, all);
  if (levels > 1 && (all - levels) % 2 != 0) --levels;
  manifest.levels.resize(levels);
  std::erase_if(manifest.chunks, [&](const ChunkInfo& c) { return c.level >= levels; });
  if (levels < all) manifest.texture.pictures.resize(manifest.texture.in_head);
  manifest.optional_blocks.clear();
}

}  // namespace

Expected<std::vector<std::uint8_t>> with_header(std::span<const std::uint8_t> pmesh,
                                                const HeaderChange& change) {
  auto manifest = parse_header(pmesh);
  if (!manifest) return tl::unexpected(manifest.error());
  const std::uint64_t start = manifest->base_offset;
  if (change.last_level) cut(*manifest, *change.last_level);
  if (change.unit) manifest->unit = *change.unit;
  std::vector<std::uint8_t> file = write_header(*manifest);
  const std::uint64_t length = manifest->file_bytes - manifest->base_offset;
  if (start > pmesh.size() || length > pmesh.size() - start)
    return fail(ErrorCode::kBadInput, "the file is cut off; publish the model again");
  const auto body = pmesh.subspan(start, length);
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

}  // namespace vitrine::server
