// SPDX-License-Identifier: Apache-2.0
// Tests that the original materials and texture coordinates of random meshes are restored exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "codec/build/face_set.h"
#include "codec/build/open_model.h"
#include "codec/build/originals.h"
#include "support/product_names.h"
#include "support/random_mesh.h"
#include "support/seeds.h"
#include "support/stored_model.h"

namespace vitrine::test {
namespace {

// Returns a finite float: random bits, or a value that may occur in a real file.
float random_float(Dice& dice) {
  const auto any = std::bit_cast<float>(static_cast<std::uint32_t>(dice.bits()));
  if (dice.one_in(3) && std::isfinite(any)) return any;
  if (dice.one_in(20)) return -0.0F;
  return static_cast<float>(dice.between(-500, 1'500)) / 1'000;
}

TextureCoordinates random_coordinates(Dice& dice) {
  const float u = random_float(dice);
  return {u, random_float(dice)};
}

std::string random_bytes(Dice& dice) {
  std::string text(dice.below(30), ' ');
  for (char& c : text)
    c = static_cast<char>(dice.below(256));
  return text;
}

TextureMap random_map(Dice& dice, std::size_t pictures, std::size_t sets) {
  TextureMap map{
      .picture = dice.below(static_cast<std::uint32_t>(pictures)),
      .coordinates = static_cast<std::uint8_t>(dice.below(static_cast<std::uint32_t>(sets))),
      .is_nearest = dice.one_in(2),
      .wrap_u = static_cast<Wrap>(dice.below(3)),
      .wrap_v = static_cast<Wrap>(dice.below(3))};
  if (dice.one_in(2)) map.transform = {.offset = {0.1, -3}, .scale = {2, -1e-9}, .rotation = 0.3};
  return map;
}

Material random_material(Dice& dice, std::size_t pictures, std::size_t sets) {
  Material material{.name = random_bytes(dice),
                    .base_colour = {0.1, 1.0 / 3, 1, 0.5},
                    .metallic = 0.25,
                    .emission = {0, 4, 1e-3},
                    .alpha_mode = static_cast<AlphaMode>(dice.below(3)),
                    .is_double_sided = dice.one_in(2),
                    .is_unlit = dice.one_in(2)};
  for (const MapOfMaterial map : kMapsOfMaterial) {
    if (dice.one_in(2)) material.*map = random_map(dice, pictures, sets);
  }
  return material;
}

// Returns a random texturing. Usually, all corners at a vertex have the same coordinates. A few
// corners have other coordinates, as at seams.
Texturing random_texturing(const LatticeMesh& mesh, Dice& dice) {
  Texturing out;
  const std::size_t sets = 1 + dice.below(2), pictures = 1 + dice.below(4);
  for (std::size_t i = 0; i < pictures; ++i) {
    const std::string bytes = random_bytes(dice);
    out.pictures.push_back({random_bytes(dice), {bytes.begin(), bytes.end()}});
  }
  const std::uint32_t materials = 1 + dice.below(5), seams = 1 + dice.below(20);
  for (std::uint32_t i = 0; i < materials; ++i)
    out.materials.push_back(random_material(dice, pictures, sets));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    out.face_materials.push_back(static_cast<std::uint16_t>(
        f == 0 || dice.one_in(seams) ? dice.below(materials) : out.face_materials.back()));
  for (std::size_t set = 0; set < sets; ++set) {
    std::vector<TextureCoordinates> at;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      at.push_back(random_coordinates(dice));
    for (const auto& [a, b, c] : mesh.faces) {
      auto& corners = out.coordinates[set].emplace_back(std::array{at[a], at[b], at[c]});
      if (dice.one_in(seams)) corners[dice.below(3)] = random_coordinates(dice);
    }
  }
  return out;
}

// Returns the model at full resolution.
Refiner refined(const StoredModel& model) {
  Refiner refiner = start_refiner(model);
  for (std::size_t i = 0; i < model.manifest.chunks.size(); ++i)
    apply_chunk(refiner, model, i);
  return refiner;
}

// Stores `texturing` in the model as the original materials and texture coordinates. The faces of
// `texturing` are in the order of mesh.faces.
StoredModel with_originals(StoredModel model, const LatticeMesh& mesh, const Texturing& texturing) {
  const auto begin = model.file.begin() + static_cast<std::ptrdiff_t>(model.manifest.base_offset);
  std::vector<std::uint8_t> body(begin, model.file.end());
  EXPECT_TRUE(add_originals(mesh.faces, static_cast<std::uint32_t>(mesh.positions.size()),
                            texturing, model.manifest, body));
  model.file = write_header(model.manifest);
  model.file.insert(model.file.end(), body.begin(), body.end());
  model.manifest = parse_header(model.file).value();
  return model;
}

void expect_originals(std::uint64_t seed) {
  Dice dice(~seed);
  const StoredModel plain =
      store_model(random_mesh(seed, 80), {.target_vertices = 4 + dice.below(20),
                                          .region_vertices = dice.one_in(2) ? 0u : 30u,
                                          .omits_components = dice.one_in(2)});
  const LatticeMesh mesh = refined(plain).lattice_mesh();
  const Texturing source = random_texturing(mesh, dice);
  const StoredModel model = with_originals(plain, mesh, source);
  ASSERT_EQ(model.manifest.file_bytes, model.file.size());
  const auto back = originals_of(refined(model), model.file);
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_TRUE(have_same_materials(*back, source));
  ASSERT_EQ(source_face_set(mesh, *back), source_face_set(mesh, source));
  ASSERT_EQ(back->face_materials, source.face_materials);
}

TEST(Originals, OfRandomTexturedMeshesComeBackToTheBit) {
  const std::uint64_t count = seeds(1'000);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_originals(seed));
    if (HasFatalFailure()) return;
  }
}

// Changes or truncates the stored description of the originals and corrects its hash. Expects that
// reading it gives an error or a result, but no crash.
void expect_no_crash(std::uint64_t seed) {
  Dice dice(seed);
  const StoredModel plain = store_model(random_mesh(seed, 40), {.target_vertices = 8});
  const LatticeMesh mesh = refined(plain).lattice_mesh();
  StoredModel model = with_originals(plain, mesh, random_texturing(mesh, dice));
  OptionalBlock& block = model.manifest.optional_blocks.front();
  const auto at = model.file.begin() + static_cast<std::ptrdiff_t>(block.offset);
  std::vector<std::uint8_t> description(at, at + static_cast<std::ptrdiff_t>(block.length));
  if (dice.one_in(4)) description.resize(dice.below(static_cast<std::uint32_t>(block.length)));
  for (std::uint32_t i = 0; i < 3 && !description.empty(); ++i)
    description[dice.below(static_cast<std::uint32_t>(description.size()))] ^=
        static_cast<std::uint8_t>(1 + dice.below(255));
  std::vector<std::uint8_t> file(model.file.begin(), at);
  const auto rest = at + static_cast<std::ptrdiff_t>(block.length);
  file.insert(file.end(), description.begin(), description.end());
  file.insert(file.end(), rest, model.file.end());
  block.length = description.size();
  block.sha256 = sha256(description);
  const std::uint64_t body = model.manifest.base_offset;
  model.file = write_header(model.manifest);
  model.file.insert(model.file.end(), file.begin() + static_cast<std::ptrdiff_t>(body), file.end());
  const auto back = originals_of(refined(model), model.file);
  if (back) {
    ASSERT_EQ(back->face_materials.size(), mesh.faces.size());
  } else {
    ASSERT_FALSE(back.error().message.empty());
  }
}

TEST(Originals, DamagedOnesGiveAnErrorOrOtherValues) {
  const std::uint64_t count = seeds(2'000);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_no_crash(seed));
    if (HasFatalFailure()) return;
  }
}

TEST(Originals, BlocksOfUnknownKindsAreSkipped) {
  const StoredModel plain = store_model(random_mesh(3, 40), {.target_vertices = 8});
  const LatticeMesh mesh = refined(plain).lattice_mesh();
  Dice dice(3);
  const Texturing source = random_texturing(mesh, dice);
  StoredModel model = with_originals(plain, mesh, source);
  model.manifest.optional_blocks.insert(
      model.manifest.optional_blocks.begin(),
      {.kind = 77'777, .length = 0, .sha256 = sha256(std::vector<std::uint8_t>())});
  const std::uint64_t body = model.manifest.base_offset;
  std::vector<std::uint8_t> file = write_header(model.manifest);
  file.insert(file.end(), model.file.begin() + static_cast<std::ptrdiff_t>(body), model.file.end());
  model.file = file;
  EXPECT_EQ(parse_header(file).value().optional_blocks.front().kind, 77'777u);
  const auto back = originals_of(refined(model), model.file);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(have_same_materials(*back, source));
}

}  // namespace
}  // namespace vitrine::test
