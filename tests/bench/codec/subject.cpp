// SPDX-License-Identifier: Apache-2.0
#include "subject.h"

#include <stdexcept>

#include "codec/base/base_decoder.h"
#include "codec/import/read_mesh.h"
#include "codec/import/repair.h"
#include "codec/progressive/refiner.h"
#include "server/jobs/build_model.h"

namespace vitrine::bench {
namespace {

template <class T>
T value_of(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

TriangleMesh read_clean(std::span<const std::uint8_t> file) {
  return value_of(repair(value_of(read_mesh(file)))).mesh;
}

Bytes build(std::span<const std::uint8_t> file, int bits) {
  BuildOptions options;
  options.bits = bits;
  return value_of(build_model(file, options, {})).file;
}

std::uint32_t decode(std::span<const std::uint8_t> pmesh) {
  const Manifest manifest = value_of(parse_header(pmesh));
  const BaseMesh base =
      value_of(decode_base(pmesh.subspan(manifest.base_offset, manifest.base_length), manifest));
  Refiner refiner = value_of(Refiner::start(manifest, base));
  for (std::size_t i = 0; i < manifest.chunks.size(); ++i) {
    const ChunkInfo& chunk = manifest.chunks[i];
    const auto bytes = pmesh.subspan(chunk.offset, chunk.length);
    if (sha256(bytes) != chunk.sha256) throw std::runtime_error("a chunk is not what it was");
    const auto applied = refiner.apply(i, bytes);
    if (!applied) throw std::runtime_error(applied.error().message);
  }
  return refiner.face_count();
}

}  // namespace vitrine::bench
