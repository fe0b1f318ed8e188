// SPDX-License-Identifier: Apache-2.0
#include "golden/golden_models.h"

#include "codec/core/byte_cursor.h"
#include "support/product_names.h"
#include "support/random_mesh.h"

namespace vitrine::test {
namespace {

// Returns a hilly square of side² vertices on the lattice, or a tube if `closed`. All numbers are
// integers, so that the mesh is the same on every machine.
LatticeMesh hills(std::uint32_t side, int bits, bool coloured, bool closed) {
  LatticeMesh mesh;
  mesh.lattice = {.origin = {-1, 2, 0.5}, .step = 0.125, .bits = bits};
  const std::int32_t pitch = ((1 << bits) - 8) / static_cast<std::int32_t>(side);
  Dice dice(side);
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const auto x = static_cast<std::int32_t>(i), y = static_cast<std::int32_t>(j);
      const std::int32_t height = ((x * x + 3 * y * y - 2 * x * y) % 97) * pitch / 60;
      mesh.positions.push_back(
          {x * pitch + dice.between(0, 3), y * pitch + dice.between(0, 3), height});
      if (coloured) {
        mesh.attributes.colours.push_back({static_cast<std::uint8_t>(5 * i),
                                           static_cast<std::uint8_t>(7 * j),
                                           static_cast<std::uint8_t>(dice.below(20))});
      }
    }
  }
  // A row of a closed tube has one quad more than a row of a sheet.
  const std::uint32_t quads = closed ? side : side - 1;
  for (std::uint32_t j = 0; j + 1 < side; ++j) {
    for (std::uint32_t i = 0; i < quads; ++i) {
      const std::uint32_t right = (i + 1) % side, up = j + 1;
      mesh.faces.push_back({j * side + i, j * side + right, up * side + right});
      mesh.faces.push_back({j * side + i, up * side + right, up * side + i});
    }
  }
  return mesh;
}

LatticeMesh with_specks(LatticeMesh mesh) {
  add_specks(mesh, 80, 1);
  return mesh;
}

}  // namespace

std::vector<GoldenModel> golden_models() {
  return {
      {"sheet_midpoint", hills(30, 10, false, false), {.target_vertices = 60}},
      {"tube_pyramid_coloured",
       hills(24, 12, true, true),
       {.placement = Placement::kPyramid, .target_vertices = 50}},
      {"sheet_regions_pyramid",
       hills(40, 14, false, false),
       {.placement = Placement::kPyramid, .target_vertices = 60, .region_vertices = 420}},
      {"parts_regions_coloured",
       random_mesh(4, 200),
       {.target_vertices = 12, .region_vertices = 40}},
      {"specks_regions_coloured",
       with_specks(hills(20, 12, true, false)),
       {.target_vertices = 60, .region_vertices = 150}},
      {"triangle",
       {.lattice = {},
        .positions = {{0, 0, 0}, {9, 0, 0}, {0, 9, 1}},
        .faces = {{0, 1, 2}},
        .attributes = {}},
       {}},
  };
}

std::string level_digests(const Manifest& manifest, const BaseMesh& base,
                          std::span<const std::uint8_t> file) {
  auto refiner = Refiner::start(manifest, base);
  if (!refiner) return refiner.error().message;
  std::string text;
  std::size_t chunk = 0;
  for (std::uint32_t level = 0; level < manifest.levels.size(); ++level) {
    for (; chunk < manifest.chunks.size() && manifest.chunks[chunk].level <= level; ++chunk) {
      const ChunkInfo& info = manifest.chunks[chunk];
      const auto bytes = file.subspan(info.offset, info.length);
      if (sha256(bytes) != info.sha256) return "a chunk's checksum differs";
      if (auto ok = refiner->apply(chunk, bytes); !ok) return ok.error().message;
    }
    ByteWriter out;
    for (const SurfaceFace& face : canonical_surface(refiner->lattice_mesh())) {
      for (const std::int32_t value : face)
        out.u32(static_cast<std::uint32_t>(value));
    }
    text += std::to_string(level) + ' ' + std::to_string(refiner->vertex_count()) + ' ' +
            std::to_string(refiner->face_count()) + ' ' + to_hex(sha256(out.take())) + '\n';
  }
  return text;
}

}  // namespace vitrine::test
