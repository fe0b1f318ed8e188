// SPDX-License-Identifier: Apache-2.0
// Header, planner and refiner on hostile bytes: what `vitrine decode` and `verify` do, and, as the
// same sources, the browser's decoder. No checksum is looked at, so that no mutation stops there.
#include <algorithm>
#include <cstdlib>

#include "codec/progressive/planner.h"
#include "codec/progressive/refiner.h"
#include "raw_base.h"

namespace vitrine {
namespace {

constexpr Limits kLimits = {.vertices = 20'000, .faces = 40'000};

std::span<const std::uint8_t> part(std::span<const std::uint8_t> bytes, std::uint64_t offset,
                                   std::uint64_t length) {
  const std::uint64_t from = std::min<std::uint64_t>(offset, bytes.size());
  return bytes.subspan(from, std::min<std::uint64_t>(length, bytes.size() - from));
}

void require(bool condition) {
  if (!condition) std::abort();
}

// What the refiner promises of every state that it reports as good.
void check(const Refiner& refiner) {
  const LatticeMesh mesh = refiner.lattice_mesh();
  require(mesh.positions.size() == refiner.vertex_count());
  require(mesh.faces.size() == refiner.face_count());
  require(Connectivity::close(refiner.vertex_count(), mesh.faces).has_value());
  std::vector<Vec3> shown;
  refiner.display_positions(shown);
  require(shown.size() >= refiner.vertex_count());
}

void decode(std::span<const std::uint8_t> bytes) {
  const auto manifest = parse_header(bytes, kLimits);
  if (!manifest) return;
  const auto base_bytes = part(bytes, manifest->base_offset, manifest->base_length);
  auto refiner = Refiner::start(*manifest, fuzz::read_raw_base(base_bytes, *manifest));
  if (!refiner) return;
  check(*refiner);
  Planner planner(*manifest);
  planner.want(WantTriangles{manifest->levels.back().faces});
  while (const auto chunk = planner.next()) {
    planner.have(*chunk);
    const ChunkInfo& info = manifest->chunks[*chunk];
    if (!refiner->apply(*chunk, part(bytes, info.offset, info.length))) return;
    check(*refiner);
  }
  refiner->undo_to_faces(refiner->face_count() / 2);
  check(*refiner);
}

}  // namespace
}  // namespace vitrine

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vitrine::decode({data, size});
  return 0;
}
