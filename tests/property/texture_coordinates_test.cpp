// SPDX-License-Identifier: Apache-2.0
// Tests texture coordinates of random meshes with random charts and seams: the atlas of the base
// mesh is coded without loss, chunks give the same coordinates in every order, and splits can be
// undone.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "codec/build/face_set.h"
#include "codec/coding/atlas_coder.h"
#include "support/product_names.h"
#include "support/random_atlas.h"
#include "support/random_mesh.h"
#include "support/seeds.h"
#include "support/stored_model.h"

namespace vitrine::test {
namespace {

constexpr std::uint32_t kTextureOrders = 4;

using TexturedFaces = std::vector<TexturedFaceKey>;

StoredModel textured_model(std::uint64_t seed) {
  Dice dice(~seed);
  const StoredModel model =
      store_model(random_mesh(seed, 300),
                  {.placement = dice.one_in(2) ? Placement::kMidpoint : Placement::kPyramid,
                   .target_vertices = 6 + dice.below(30),
                   .region_vertices = 16 + dice.below(60),
                   .omits_components = false});
  return with_atlas(model, random_atlas(model.base, seed));
}

// Returns the texture coordinates of each face, starting with the smallest corner, in sorted order.
std::vector<std::array<Vec2i, 3>> coordinates_of(const TexturedFaces& faces) {
  std::vector<std::array<Vec2i, 3>> out;
  for (const TexturedFaceKey& face : faces) {
    const Vec2i a = face[0].texture, b = face[1].texture, c = face[2].texture;
    out.push_back(std::min({std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}}));
  }
  std::ranges::sort(out);
  return out;
}

TEST(TextureCoordinates, ManyRandomModelsHaveSeamsAndRegions) {
  std::uint32_t with_seams = 0, forked = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const StoredModel model = textured_model(seed);
    with_seams += model.base.atlas.coordinates.size() > model.base.positions.size() ? 1 : 0;
    forked += model.manifest.tree.leaves() > 1 ? 1 : 0;
  }
  EXPECT_GE(with_seams, 30u);
  EXPECT_GE(forked, 20u);
}

void expect_atlas_comes_back(std::uint64_t seed) {
  const BaseMesh base = textured_model(seed).base;
  const auto bytes = encode_atlas(base);
  BaseMesh plain = base;
  plain.atlas = {};
  const auto atlas = decode_atlas(bytes, plain);
  ASSERT_TRUE(atlas) << atlas.error().message;
  ASSERT_EQ(atlas->wedges, base.atlas.wedges);
  ASSERT_EQ(atlas->coordinates, base.atlas.coordinates);
}

TEST(TextureCoordinates, TheAtlasOfTheBaseMeshComesBackExactly) {
  const std::uint64_t count = seeds(1'000);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_atlas_comes_back(seed));
    if (HasFatalFailure()) return;
  }
}

TEST(TextureCoordinates, ALatticeOfCoordinatesIsFoundAndSavesItsBits) {
  std::size_t exact = 0, coarse = 0, wedges = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    BaseMesh base = textured_model(seed).base;
    exact += encode_atlas(base).size();
    for (Vec2i& at : base.atlas.coordinates)
      at = {at.x & ~0xFFF, at.y & ~0xFFF};
    const auto bytes = encode_atlas(base);
    coarse += bytes.size();
    wedges += base.atlas.coordinates.size();
    BaseMesh plain = base;
    plain.atlas = {};
    const auto atlas = decode_atlas(bytes, plain);
    ASSERT_TRUE(atlas) << atlas.error().message;
    ASSERT_EQ(atlas->coordinates, base.atlas.coordinates);
  }
  EXPECT_LT(coarse, exact - wedges);
}

// A wedge holds the texture coordinates of one or more corners at a vertex. Expects that every
// corner of a real face has a wedge of its vertex, and that all other corners have none.
void expect_wedges(const Refiner& refiner) {
  const Connectivity& mesh = refiner.connectivity();
  const Wedges& wedges = refiner.wedges();
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (!mesh.is_real(c / 3)) {
      ASSERT_EQ(wedges.of(c), kNoWedge);
    } else {
      ASSERT_LT(wedges.of(c), wedges.size());
      ASSERT_EQ(wedges[wedges.of(c)].vertex, mesh.vertex(c));
    }
  }
}

// Applies all chunks in a random order. `known` holds the faces of each set of chunks that an
// earlier order reached. If this order reaches the same set, its coordinates must be the same.
void refine_textured_at_random(const StoredModel& model, Dice& dice,
                               std::map<std::vector<bool>, TexturedFaces>& known) {
  Refiner refiner = start_refiner(model);
  std::vector<bool> applied(model.manifest.chunks.size(), false);
  for (std::size_t step = 0; step < applied.size(); ++step) {
    const auto ready = ready_chunks(refiner);
    const std::size_t chunk = ready[dice.below(static_cast<std::uint32_t>(ready.size()))];
    apply_chunk(refiner, model, chunk);
    applied[chunk] = true;
    expect_wedges(refiner);
    TexturedFaces faces = textured_face_set(refiner);
    const auto [before, is_new] = known.emplace(applied, faces);
    ASSERT_TRUE(is_new || before->second == faces) << "after chunk " << chunk;
  }
}

void expect_same_coordinates(std::uint64_t seed) {
  StoredModel model = textured_model(seed);
  Dice dice(seed);
  std::map<std::vector<bool>, TexturedFaces> known;
  for (std::uint32_t order = 0; order < kTextureOrders; ++order) {
    refine_textured_at_random(model, dice, known);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(TextureCoordinates, TheSameChunksGiveTheSameCoordinatesInEveryOrder) {
  const std::uint64_t count = seeds(150);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_THROW(expect_same_coordinates(seed));
    if (HasFatalFailure()) return;
  }
}

TEST(TextureCoordinates, DoNotChangeTheSurface) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const StoredModel textured = textured_model(seed);
    StoredModel plain = textured;
    plain.base.atlas = {};
    Refiner one = start_refiner(textured), other = start_refiner(plain);
    for (std::size_t i = 0; i < textured.manifest.chunks.size(); ++i)
      apply_chunk(one, textured, i), apply_chunk(other, plain, i);
    ASSERT_EQ(canonical_surface(one.lattice_mesh()), canonical_surface(other.lattice_mesh()));
    EXPECT_TRUE(other.wedges().empty());
  }
}

// Applies the first `chunks` chunks in file order, then undoes a part of the last chunk, and then
// all of it. The texture coordinates must then be the same as before the last chunk.
void expect_coordinates_undone(const StoredModel& model, Dice& dice, std::size_t chunks) {
  Refiner refiner = start_refiner(model);
  for (std::size_t i = 0; i + 1 < chunks; ++i)
    apply_chunk(refiner, model, i);
  const auto before = coordinates_of(textured_face_set(refiner));
  const std::uint32_t coarse = refiner.face_count();
  apply_chunk(refiner, model, chunks - 1);
  refiner.undo_to_faces(coarse + dice.below(refiner.face_count() - coarse + 1));
  expect_wedges(refiner);
  refiner.undo_to_faces(0);
  expect_wedges(refiner);
  ASSERT_EQ(coordinates_of(textured_face_set(refiner)), before);
}

TEST(TextureCoordinates, AreThoseBeforeAChunkWhenItIsUndone) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StoredModel model = textured_model(seed);
    Dice dice(seed);
    const auto all = static_cast<std::uint32_t>(model.manifest.chunks.size());
    for (int i = 0; i < 4 && all > 0; ++i) {
      expect_coordinates_undone(model, dice, 1 + dice.below(all));
      if (HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace vitrine::test
