// SPDX-License-Identifier: Apache-2.0
#include "codec/build/coarser_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/export/write_mesh.h"
#include "support/meshes.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Manifest with_faces(std::initializer_list<std::uint32_t> counts) {
  Manifest manifest;
  for (const std::uint32_t faces : counts)
    manifest.levels.push_back({.faces = faces});
  return manifest;
}

TEST(CoarserLevels, AreAFactorOfFourApartDownToTheBaseMesh) {
  const Manifest manifest = with_faces({10, 30, 100, 390, 400, 900, 1600});
  EXPECT_THAT(coarser_levels(manifest, 6, 1600), ElementsAre(4, 2, 0));
  EXPECT_THAT(coarser_levels(manifest, 6, 1599), ElementsAre(3, 1, 0));
  EXPECT_THAT(coarser_levels(manifest, 2, 1600), ElementsAre(2, 0)) << "up to the finest allowed";
  EXPECT_THAT(coarser_levels(manifest, 1, 30), ElementsAre(0)) << "the base mesh is always there";
  EXPECT_THAT(coarser_levels(manifest, 0, 11), ElementsAre(0));
  EXPECT_THAT(coarser_levels(manifest, 0, 10), IsEmpty());
}

TEST(CoarserLevels, AreDecodedAsIfEachWereAskedForAlone) {
  const auto ply = write_mesh(test::torus(60, 40), MeshFormat::kPly);
  const auto file = build_model(*ply, {}, {}).value().file;
  auto whole = open_model(file);
  ASSERT_TRUE(whole);
  const auto last = static_cast<std::uint32_t>(whole->manifest().levels.size() - 1);
  const auto chosen = coarser_levels(whole->manifest(), last, whole->manifest().levels[last].faces);
  ASSERT_GE(chosen.size(), 2u);
  const ChunkReader read = chunks_of(whole->manifest(), file);
  const auto levels = decode_levels(open_model(file).value(), chosen, false, read);
  ASSERT_TRUE(levels);
  ASSERT_EQ(levels->size(), chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    auto alone = open_model(file);
    ASSERT_TRUE(refine(*alone, WantLevel{chosen[i]}, read));
    const CoarserLevel& level = (*levels)[i];
    EXPECT_EQ(level.mesh.positions, alone->display_mesh().positions);
    EXPECT_EQ(level.mesh.faces, alone->display_mesh().faces);
    EXPECT_EQ(level.level, chosen[i]);
    EXPECT_EQ(level.error, whole->manifest().levels[chosen[i]].max_error);
    EXPECT_EQ(level.grid.step, shown_detail(*alone).grid_step);
    EXPECT_THAT(level.coordinates, IsEmpty());
  }
}

}  // namespace
}  // namespace vitrine
