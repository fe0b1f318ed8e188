// SPDX-License-Identifier: Apache-2.0
// Tests the sizes of the pictures in a baked texture.
#include "codec/bake/bake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/picture/decode_picture.h"
#include "support/product_names.h"
#include "support/textured_mesh.h"

namespace vitrine::test {
namespace {

using ::testing::ElementsAre;

// Bakes `source`. Each face keeps its place in the source's picture, reduced by `scale`. The finest
// picture then has 1.14 / scale times the source's side, rounded up to a multiple of 64.
BakedTexture baked(const ImportedMesh& source, double scale) {
  std::vector<DisplayFace> display;
  for (const auto& corners : source.texturing.coordinates[0]) {
    DisplayFace& face = display.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      face[k] = Vec2{corners[k][0], corners[k][1]} * scale;
  }
  return bake(source.mesh, source.texturing, display).value();
}

std::vector<std::uint32_t> sides_of(const BakedTexture& texture, PictureRole role) {
  std::vector<std::uint32_t> sides;
  for (const BakedPicture& picture : texture.pictures) {
    const Picture decoded = decode_picture(picture.bytes, 1 << 24).value();
    EXPECT_EQ(decoded.width, picture.side);
    EXPECT_EQ(decoded.height, picture.side);
    if (picture.role == role) sides.push_back(picture.side);
  }
  return sides;
}

TEST(BakedTexture, HasThreeQuartersOfTheFinestSizeAndSurfaceMapsOfHalfTheSize) {
  ImportedMesh source = textured_torus(20, 10, 640);
  source.texturing.materials[0].metallic_roughness_map = TextureMap{};
  const BakedTexture texture = baked(source, 1);
  EXPECT_THAT(sides_of(texture, PictureRole::kBaseColour), ElementsAre(192, 384, 576, 768));
  EXPECT_THAT(sides_of(texture, PictureRole::kSurface), ElementsAre(192, 384));
  EXPECT_EQ(texture.pictures[0].role, PictureRole::kBaseColour);
}

TEST(BakedTexture, HasThreeQuartersOfASizeThatIsNotTheFinest) {
  const BakedTexture texture = baked(textured_torus(20, 10, 380), 0.33);
  EXPECT_THAT(sides_of(texture, PictureRole::kBaseColour), ElementsAre(168, 336, 504, 672, 1'344));
}

TEST(BakedTexture, HasOnlyHalvingsOfASmallPicture) {
  const BakedTexture texture = baked(textured_torus(20, 10, 256), 0.5);
  EXPECT_THAT(sides_of(texture, PictureRole::kBaseColour), ElementsAre(160, 320, 640));
}

}  // namespace
}  // namespace vitrine::test
