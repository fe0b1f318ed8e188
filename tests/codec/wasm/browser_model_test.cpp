// SPDX-License-Identifier: Apache-2.0
// Opens and refines models with and without a texture, as the browser's viewer does.
#include "codec/wasm/browser_model.h"

#include <gtest/gtest.h>

#include "codec/base/base_decoder.h"
#include "codec/build/build_model.h"
#include "support/textured_torus.h"

namespace vitrine::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kTriangles = 0, kLevel = 3;  // values of the argument `kind` of want()

// The surface as a page receives it.
struct Shown {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::int16_t, 4>> normals;
  std::vector<std::array<float, 2>> coordinates;
  std::vector<Triangle> faces;
  bool operator==(const Shown&) const = default;
};

Shown shown(BrowserModel& model) {
  Shown out;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  model.display();
  while (model.next_vertices() > 0) {
    append(out.positions, model.positions());
    append(out.normals, model.normals());
    append(out.coordinates, model.coordinates());
  }
  while (model.next_faces() > 0)
    append(out.faces, model.faces());
  return out;
}

class BrowserModelTest : public ::testing::Test {
 protected:
  void open(ImportedMesh mesh) {
    auto built = build_model(std::move(mesh), {});
    ASSERT_TRUE(built) << built.error().message;
    file_ = std::move(built->file);
    model_ = *BrowserModel::open(file_);
    const Manifest& m = model_->manifest();
    const auto base = part(m.base_offset, m.base_length);
    ASSERT_TRUE(model_->check_base(base));
    ASSERT_TRUE(model_->start(*decode_base(base, m), atlas()));
  }

  std::span<const std::uint8_t> part(std::uint64_t offset, std::uint64_t length) const {
    return std::span(file_).subspan(offset, length);
  }
  std::span<const std::uint8_t> atlas() const {
    const TextureInfo& texture = model_->manifest().texture;
    return part(texture.atlas_offset, texture.atlas_length);
  }

  // Applies the chunks for a detail request. Calls `applied` after each chunk.
  template <class Applied>
  void reach(std::uint32_t kind, double value, const Applied& applied) {
    ASSERT_TRUE(model_->want(kind, value));
    for (int i = model_->next_chunk(); i >= 0; i = model_->next_chunk()) {
      const auto chunk = static_cast<std::size_t>(i);
      const ChunkInfo& info = model_->manifest().chunks[chunk];
      ASSERT_TRUE(model_->apply(chunk, part(info.offset, info.length)));
      applied();
    }
    model_->trim();
  }
  void reach(std::uint32_t kind, double value) {
    reach(kind, value, [] {});
  }

  // Expects that each displayed corner has the position and the texture coordinates of the same
  // corner in the mesh.
  void expect_corners_of_mesh() {
    const Shown surface = shown(*model_);
    const Refiner& refiner = model_->refiner();
    const auto faces = refiner.lattice_mesh().faces;
    const auto coordinates = refiner.texture_coordinates();
    ASSERT_EQ(surface.faces.size(), faces.size());
    ASSERT_EQ(surface.positions.size(), model_->displayed_vertices());
    ASSERT_EQ(surface.coordinates.size(), model_->displayed_vertices());
    std::vector<std::array<float, 3>> at(refiner.vertex_count());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k)
        at[faces[f][k]] = surface.positions[surface.faces[f][k]];
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(surface.positions[surface.faces[f][k]], at[faces[f][k]]);
        ASSERT_EQ(surface.coordinates[surface.faces[f][k]], coordinates[f][k]);
      }
    }
  }

  Bytes file_;
  std::unique_ptr<BrowserModel> model_;
};

TEST_F(BrowserModelTest, AVertexOnASeamIsShownOnceForEachOfItsTextureCoordinates) {
  open(textured_torus(60, 40));
  EXPECT_GT(model_->displayed_vertices(), model_->refiner().vertex_count());
  expect_corners_of_mesh();
  reach(kLevel, 1e9, [&] { expect_corners_of_mesh(); });
  EXPECT_EQ(shown(*model_).faces.size(), 60u * 40 * 2);
}

TEST_F(BrowserModelTest, ANewTexturedVertexComesFromOneThatWasShownBefore) {
  open(textured_torus(60, 40));
  for (VertexId v = 0; v < model_->displayed_vertices(); ++v)
    ASSERT_EQ(model_->parent_of(v), v);
  std::uint32_t before = model_->displayed_vertices();
  reach(kLevel, 1e9, [&] {
    for (VertexId v = 0; v < before; ++v)
      ASSERT_EQ(model_->parent_of(v), v);
    for (VertexId v = before; v < model_->displayed_vertices(); ++v)
      ASSERT_LT(model_->parent_of(v), v);
    before = model_->displayed_vertices();
  });
}

TEST_F(BrowserModelTest, ATexturedSurfaceHasTheRequestedNumberOfTriangles) {
  open(textured_torus(60, 40));
  const std::uint32_t wanted = model_->refiner().face_count() + 1001;
  reach(kTriangles, wanted);
  EXPECT_LE(model_->refiner().face_count(), wanted);
  EXPECT_GT(model_->refiner().face_count(), wanted - 2);
  expect_corners_of_mesh();
}

TEST_F(BrowserModelTest, ARestartShowsTheTexturedBaseMeshAgain) {
  open(textured_torus(60, 40));
  const Shown base = shown(*model_);
  reach(kLevel, 1e9);
  ASSERT_NE(shown(*model_), base);
  EXPECT_TRUE(*model_->want(kLevel, 0));
  EXPECT_EQ(shown(*model_), base);
}

TEST_F(BrowserModelTest, DamagedAtlasesAndPicturesAreRefused) {
  open(textured_torus(30, 20));
  const auto damaged = [](std::span<const std::uint8_t> bytes) {
    Bytes copy(bytes.begin(), bytes.end());
    copy[copy.size() / 2] ^= 1;
    return copy;
  };
  EXPECT_TRUE(model_->check_atlas(atlas()));
  EXPECT_FALSE(model_->check_atlas(damaged(atlas())));
  const auto& pictures = model_->manifest().texture.pictures;
  ASSERT_FALSE(pictures.empty());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto bytes = part(pictures[i].offset, pictures[i].length);
    EXPECT_TRUE(model_->check_picture(i, bytes));
    EXPECT_FALSE(model_->check_picture(i, damaged(bytes)));
  }
  EXPECT_FALSE(model_->check_picture(pictures.size(), {}));
}

TEST_F(BrowserModelTest, TheSummaryEndsWithTheTexture) {
  open(textured_torus(30, 20));
  const Manifest& m = model_->manifest();
  const std::vector<double> summary = model_->summary();
  const std::size_t begin = 11 + 5 * m.levels.size() + 4 * m.chunks.size();
  ASSERT_EQ(summary.size(), begin + 8 + 4 * m.texture.pictures.size());
  const auto at = [&](std::size_t i) { return summary[begin + i]; };
  EXPECT_EQ(at(0), static_cast<double>(m.texture.atlas_offset));
  EXPECT_EQ(at(1), static_cast<double>(m.texture.atlas_length));
  EXPECT_EQ(at(6), static_cast<double>(m.texture.pictures.size()));
  EXPECT_EQ(at(7), m.texture.in_head);
  EXPECT_EQ(at(9), m.texture.pictures[0].side);
  EXPECT_EQ(at(10), static_cast<double>(m.texture.pictures[0].offset));
}

TEST_F(BrowserModelTest, AModelWithoutATextureIsShownByItsVertices) {
  open({.mesh = torus(30, 20)});
  reach(kLevel, 1e9);
  const Shown surface = shown(*model_);
  EXPECT_EQ(surface.positions.size(), 600u);
  EXPECT_TRUE(surface.coordinates.empty());
  EXPECT_EQ(surface.faces, model_->refiner().lattice_mesh().faces);
  const Manifest& m = model_->manifest();
  EXPECT_EQ(model_->summary().size(), 11 + 5 * m.levels.size() + 4 * m.chunks.size());
}

}  // namespace
}  // namespace vitrine::test
