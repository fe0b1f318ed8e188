// SPDX-License-Identifier: Apache-2.0
// Runs the header's reader, the reader of the atlas, the planner and the refiner on hostile bytes,
// as `vitrine decode` does. Corrects the hash of the header and ignores all other hashes, because
// they would make the decoder refuse mutated bytes.
#include <optional>

#include "../bounded.h"
#include "../checks.h"
#include "codec/coding/atlas_coder.h"
#include "codec/plan/planner.h"
#include "codec/refine/refiner.h"
#include "decoding_bound.h"
#include "raw_base.h"
#include "support/sealed.h"

namespace vitrine {
namespace {

using fuzz::part;
using fuzz::require;

constexpr Limits kLimits = {.vertices = 20'000, .faces = 40'000};

// If the model has a texture, checks that every corner of a face has a wedge of the corner's
// vertex.
void check_wedges(const Refiner& refiner) {
  const Wedges& wedges = refiner.wedges();
  if (wedges.empty()) return;
  const Connectivity& mesh = refiner.connectivity();
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (!mesh.is_real(c / 3)) continue;
    require(wedges.of(c) < wedges.size() && wedges[wedges.of(c)].vertex == mesh.vertex(c));
  }
}

// Checks the guarantees of the refiner, after each chunk that it has accepted.
void check(const Refiner& refiner) {
  const LatticeMesh mesh = refiner.lattice_mesh();
  require(mesh.positions.size() == refiner.vertex_count());
  require(mesh.faces.size() == refiner.face_count());
  const auto closed = Connectivity::close(refiner.vertex_count(), mesh.faces);
  require(closed && closed->loop_count() == refiner.connectivity().loop_count());
  const TriangleMesh shown = refiner.display_mesh();
  require(shown.positions.size() >= refiner.vertex_count());
  require(shown.faces.size() == refiner.face_count());
  require(shown.attributes.fit(shown.positions.size()));
  check_wedges(refiner);
}

// Reads the base mesh, and the atlas if the model has a texture. Returns nullopt if the atlas is
// damaged.
std::optional<BaseMesh> read_base(std::span<const std::uint8_t> bytes, const Manifest& manifest) {
  BaseMesh base =
      fuzz::read_raw_base(part(bytes, manifest.base_offset, manifest.base_length), manifest);
  const TextureInfo& texture = manifest.texture;
  if (texture.empty()) return base;
  auto atlas = decode_atlas(part(bytes, texture.atlas_offset, texture.atlas_length), base);
  if (!atlas) return std::nullopt;
  base.atlas = std::move(*atlas);
  return base;
}

// Checks that the planner terminates for several kinds of requests and plans no chunk twice.
void plan(const Manifest& manifest) {
  const std::uint32_t level = static_cast<std::uint32_t>(manifest.levels.size()) / 2;
  for (const Want& want :
       {Want(WantLevel{level}), Want(WantBytes{manifest.cumulative_bytes(level)}),
        Want(WantError{manifest.levels[level].max_error})}) {
    Planner planner(manifest);
    planner.want(want);
    std::vector<bool> planned(manifest.chunks.size(), false);
    while (const auto chunk = planner.next()) {
      require(!planned[*chunk]);
      planned[*chunk] = true;
      planner.have(*chunk);
    }
  }
}

// Returns a view from a camera so close to a corner of the model that a part of the model is out of
// sight.
View close_up(const Lattice& lattice) {
  const double side = lattice.step * (1 << lattice.bits);
  const Vec3 eye = lattice.origin + Vec3{0.2, 0.2, 1.3} * side;
  return {.camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, eye.x, eye.y, eye.z, 1},
          .field_of_view = 30,
          .width = 800,
          .height = 600};
}

// Applies the planned chunks in order. Returns false if the refiner refuses a chunk as damaged.
bool apply(Refiner& refiner, Planner& planner, std::span<const std::uint8_t> bytes) {
  while (const auto chunk = planner.next()) {
    require(refiner.is_ready(*chunk));
    planner.have(*chunk);
    const ChunkInfo& info = refiner.manifest().chunks[*chunk];
    if (!refiner.apply(*chunk, part(bytes, info.offset, info.length))) return false;
    require(refiner.is_applied(*chunk) && !refiner.is_ready(*chunk));
    check(refiner);
  }
  return true;
}

void decode(std::span<const std::uint8_t> bytes) {
  const auto manifest = parse_header(bytes, kLimits);
  if (!manifest) return;
  const auto base = read_base(bytes, *manifest);
  if (!base) return;
  auto refiner = Refiner::start(*manifest, *base);
  if (!refiner) return;
  check(*refiner);
  plan(*manifest);
  Planner planner(*manifest);
  if (const View view = close_up(manifest->lattice); is_sane(view)) planner.want(view);
  if (!apply(*refiner, planner, bytes)) return;
  planner.want(WantTriangles{manifest->levels.back().faces});
  if (!apply(*refiner, planner, bytes)) return;
  refiner->undo_to_faces(refiner->face_count() / 2);
  check(*refiner);
}

}  // namespace
}  // namespace vitrine

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = vitrine::test::sealed({data, size});
  vitrine::fuzz::bounded(vitrine::fuzz::decoding_bound(file), size, [&] { vitrine::decode(file); });
  return 0;
}
