// SPDX-License-Identifier: Apache-2.0
#include "golden/golden_models.h"

#include <array>
#include <span>

#include "codec/build/face_set.h"
#include "codec/build/open_model.h"
#include "codec/core/byte_cursor.h"
#include "support/product_names.h"
#include "support/random_atlas.h"
#include "support/random_mesh.h"

namespace vitrine::test {
namespace {

// Returns a hilly square of side² vertices on the lattice, or a tube if `closed` is true. All
// computations use integers, so the mesh is the same on every machine.
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
  // A closed row of a tube has one more square than a row of a sheet.
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

std::string surface_digest(const Refiner& refiner) {
  ByteWriter out;
  for (const SurfaceFace& face : canonical_surface(refiner.lattice_mesh())) {
    for (const std::int32_t value : face)
      out.u32(static_cast<std::uint32_t>(value));
  }
  return to_hex(sha256(out.take()));
}

std::string texture_digest(const Refiner& refiner) {
  ByteWriter out;
  for (const TexturedFaceKey& face : textured_face_set(refiner)) {
    for (const auto& [p, uv] : face) {
      for (const std::int32_t value : {p.x, p.y, p.z, uv.x, uv.y})
        out.u32(static_cast<std::uint32_t>(value));
    }
  }
  return to_hex(sha256(out.take()));
}

// Lossless WebP files with one pixel each.
constexpr std::array<std::uint8_t, 38> kOchre = {
    0x52, 0x49, 0x46, 0x46, 0x1e, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56,
    0x50, 0x38, 0x4c, 0x11, 0x00, 0x00, 0x00, 0x2f, 0x00, 0x00, 0x00, 0x00, 0x07,
    0x50, 0xcb, 0x22, 0x97, 0xac, 0xff, 0x81, 0x88, 0xe8, 0x7f, 0x00, 0x00};
constexpr std::array<std::uint8_t, 38> kFlatNormal = {
    0x52, 0x49, 0x46, 0x46, 0x1e, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56,
    0x50, 0x38, 0x4c, 0x11, 0x00, 0x00, 0x00, 0x2f, 0x00, 0x00, 0x00, 0x00, 0x07,
    0x50, 0xc0, 0x02, 0xf6, 0xbf, 0xff, 0x81, 0x88, 0xe8, 0x7f, 0x00, 0x00};

// Adds two pictures to a textured model: one in the file's head, and one after the chunks.
StoredModel with_pictures(StoredModel model) {
  model.manifest = parse_header(model.file).value();
  const std::span<const std::uint8_t> before(model.file);
  const std::uint64_t body = model.manifest.base_offset, chunks = model.manifest.head_bytes();
  TextureInfo& texture = model.manifest.texture;
  texture.in_head = 1;
  texture.pictures = {{.role = PictureRole::kBaseColour,
                       .side = 1,
                       .length = kOchre.size(),
                       .sha256 = sha256(kOchre)},
                      {.role = PictureRole::kNormal,
                       .side = 1,
                       .length = kFlatNormal.size(),
                       .sha256 = sha256(kFlatNormal)}};
  std::vector<std::uint8_t> file = write_header(model.manifest);
  for (const auto part :
       {before.subspan(body, chunks - body), std::span<const std::uint8_t>(kOchre),
        before.subspan(chunks), std::span<const std::uint8_t>(kFlatNormal)})
    file.insert(file.end(), part.begin(), part.end());
  model.file = std::move(file);
  return model;
}

}  // namespace

StoredModel stored(const GoldenModel& golden) {
  StoredModel model = store_model(golden.mesh, golden.options);
  if (!golden.is_textured) return model;
  const BaseAtlas atlas = random_atlas(model.base, 1);
  return with_pictures(with_atlas(std::move(model), atlas));
}

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
      {"sheet_regions_textured",
       hills(40, 14, false, false),
       {.target_vertices = 60, .region_vertices = 420, .omits_components = false},
       true},
      {"parts_regions_textured",
       random_mesh(4, 200),
       {.target_vertices = 40, .region_vertices = 40, .omits_components = false},
       true},
      {"triangle",
       {.lattice = {},
        .positions = {{0, 0, 0}, {9, 0, 0}, {0, 9, 1}},
        .faces = {{0, 1, 2}},
        .attributes = {}},
       {}},
  };
}

std::string level_digests(std::span<const std::uint8_t> file) {
  auto refiner = open_model(file);
  if (!refiner) return refiner.error().message;
  const Manifest& manifest = refiner->manifest();
  const ChunkReader read = chunks_of(manifest, file);
  std::string text;
  std::size_t chunk = 0;
  for (std::uint32_t level = 0; level < manifest.levels.size(); ++level) {
    for (; chunk < manifest.chunks.size() && manifest.chunks[chunk].level <= level; ++chunk) {
      const auto bytes = read(chunk);
      if (!bytes) return bytes.error().message;
      if (auto ok = refiner->apply(chunk, *bytes); !ok) return ok.error().message;
    }
    text += std::to_string(level) + ' ' + std::to_string(refiner->vertex_count()) + ' ' +
            std::to_string(refiner->face_count()) + ' ' + surface_digest(*refiner);
    if (!refiner->wedges().empty()) text += ' ' + texture_digest(*refiner);
    text += '\n';
  }
  return text;
}

}  // namespace vitrine::test
