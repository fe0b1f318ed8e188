// SPDX-License-Identifier: Apache-2.0
#include "subject.h"

#include <stdexcept>

#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/build/refine.h"
#include "codec/import/read_mesh.h"
#include "codec/repair/repair.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

template <class T>
T checked(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

void apply(Refiner& refiner, std::size_t chunk, const ChunkReader& read) {
  const auto applied = refiner.apply(chunk, checked(read(chunk)));
  if (!applied) throw std::runtime_error(applied.error().message);
}

}  // namespace

TriangleMesh read_clean(std::span<const std::uint8_t> file) {
  return checked(repair(checked(read_mesh(file)))).mesh;
}

Bytes build(std::span<const std::uint8_t> file, int bits, Placement placement,
            CollapseOrder order) {
  BuildOptions options;
  options.bits = bits;
  options.placement = placement;
  options.order = order;
  return checked(build_model(file, options, {})).file;
}

Bytes build_on(std::span<const std::uint8_t> file, int bits, unsigned threads) {
  return checked(build_model(file, {.bits = bits, .threads = threads}, {})).file;
}

Bytes build_in_one_region(std::span<const std::uint8_t> file, int bits) {
  BuildOptions options;
  options.bits = bits;
  options.region_vertices = 0;
  return checked(build_model(file, options, {})).file;
}

std::uint32_t decode(std::span<const std::uint8_t> pmesh) {
  Refiner refiner = checked(open_model(pmesh));
  const ChunkReader read = chunks_of(refiner.manifest(), pmesh);
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i)
    apply(refiner, i, read);
  return refiner.face_count();
}

std::vector<Level> decode_levels(std::span<const std::uint8_t> pmesh) {
  Refiner refiner = checked(open_model(pmesh));
  const Manifest& manifest = refiner.manifest();
  const ChunkReader read = chunks_of(manifest, pmesh);
  std::vector<Level> levels;
  std::size_t chunk = 0;
  for (std::uint32_t level = 0; level < manifest.levels.size(); ++level) {
    while (chunk < manifest.chunks.size() && manifest.chunks[chunk].level == level)
      apply(refiner, chunk++, read);
    levels.push_back({manifest.cumulative_bytes(level), refiner.display_mesh()});
  }
  return levels;
}

}  // namespace vitrine::bench
