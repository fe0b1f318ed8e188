// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "textured_square.h"

namespace vitrine::test {
namespace {

using Pixel = std::array<int, 4>;

// Returns a picture of four pixels: red at the upper left, green at the upper right, blue at the
// lower left, white at the lower right.
Picture four_colours() {
  return picture_of(2, 2, [](int x, int y) -> std::array<std::uint8_t, 4> {
    if (y == 0)
      return x == 0 ? std::array<std::uint8_t, 4>{255, 0, 0, 255}
                    : std::array<std::uint8_t, 4>{0, 255, 0, 255};
    return x == 0 ? std::array<std::uint8_t, 4>{0, 0, 255, 255}
                  : std::array<std::uint8_t, 4>{255, 255, 255, 255};
  });
}

constexpr Pixel kPureRed = {255, 0, 0, 255}, kPureGreen = {0, 255, 0, 255},
                kPureBlue = {0, 0, 255, 255}, kPureWhite = {255, 255, 255, 255};

TEST(TexturedRender, AnUnlitTextureIsShownUpright) {
  TexturedSquare square;
  square.show(four_colours()).is_nearest = true;
  const Picture picture = square.seen(32);
  EXPECT_EQ(pixel_of(picture, 4, 4), kPureRed);
  EXPECT_EQ(pixel_of(picture, 28, 4), kPureGreen);
  EXPECT_EQ(pixel_of(picture, 4, 28), kPureBlue);
  EXPECT_EQ(pixel_of(picture, 28, 28), kPureWhite);
}

TEST(TexturedRender, ATransformScalesTurnsAndShiftsTheCoordinates) {
  TexturedSquare square;
  TextureMap& map = square.show(four_colours());
  map.is_nearest = true;
  map.transform = {.offset = {0.5, 0}, .scale = {0.25, 0.25}, .rotation = 0};
  EXPECT_EQ(pixel_of(square.seen(8), 4, 4), kPureGreen);
  // Rotates by a quarter turn counter-clockwise about the upper left corner: (u, v) becomes (v,
  // -u).
  map.transform = {.offset = {0, 1}, .scale = {1, 1}, .rotation = std::numbers::pi / 2};
  const Picture turned = square.seen(32);
  EXPECT_EQ(pixel_of(turned, 4, 4), kPureBlue);
  EXPECT_EQ(pixel_of(turned, 28, 4), kPureRed);
}

TEST(TexturedRender, CoordinatesOutsideThePictureRepeatMirrorOrStop) {
  TexturedSquare square;
  TextureMap& map = square.show(four_colours());
  map.is_nearest = true;
  map.transform.offset = {1, 0};
  EXPECT_EQ(pixel_of(square.seen(32), 4, 4), kPureRed);
  map.wrap_u = Wrap::kMirror;
  EXPECT_EQ(pixel_of(square.seen(32), 4, 4), kPureGreen);
  map.wrap_u = Wrap::kClamp;
  EXPECT_EQ(pixel_of(square.seen(32), 28, 4), kPureGreen);
}

TEST(TexturedRender, FactorMapAndVertexColourMultiplyInLinearLight) {
  TexturedSquare square;
  square.show(plain_picture({188, 188, 188, 255}));  // sRGB value for half the light of white
  square.material().base_colour = {0.5, 1, 1, 1};
  square.mesh.attributes.colours.assign(4, Colour{255, 188, 255});
  const Pixel pixel = pixel_of(square.seen(4), 1, 1);
  EXPECT_NEAR(pixel[0], 137, 1);  // sRGB value for a quarter of the light of white
  EXPECT_NEAR(pixel[1], 137, 1);
  EXPECT_NEAR(pixel[2], 188, 1);
}

TEST(TexturedRender, AMaterialWithoutMapsLeavesVertexColoursAsTheyAre) {
  TexturedSquare square;
  square.material().is_unlit = false;
  square.mesh.attributes.colours = {{200, 20, 20}, {20, 200, 20}, {20, 20, 200}, {90, 80, 70}};
  const Framing frame{.centre = {}, .pixel = 0.1, .width = 20, .height = 20, .toward = {0, 0, 1}};
  EXPECT_EQ(square.seen(20).pixels, render(square.mesh, frame).pixels);
}

TEST(TexturedRender, ACheckerboardSeenFromFarIsEvenGrey) {
  TexturedSquare square;
  square.show(picture_of(512, 512, [](int x, int y) -> std::array<std::uint8_t, 4> {
    const auto shade = static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0);
    return {shade, shade, shade, 255};
  }));
  const Picture picture = square.seen(16);
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x)
      EXPECT_EQ(pixel_of(picture, x, y), (Pixel{188, 188, 188, 255})) << x << ' ' << y;
  }
}

// Returns the brightness of a lit white square with a normal map. All pixels of the map have the
// colour `normal`.
int brightness(TexturedSquare square, const std::array<std::uint8_t, 4>& normal) {
  square.pictures = {plain_picture(normal)};
  square.material().is_unlit = false;
  square.material().normal_map.emplace();
  return pixel_of(square.seen(4), 1, 1)[1];
}

TEST(TexturedRender, ANormalMapTurnsTheSurfaceToTheLampAtTheUpperLeft) {
  const TexturedSquare square;
  const int flat = brightness(square, {128, 128, 255, 255});
  EXPECT_GT(brightness(square, {64, 128, 238, 255}), flat);   // normal tilted to the left
  EXPECT_LT(brightness(square, {192, 128, 238, 255}), flat);  // normal tilted to the right
  EXPECT_GT(brightness(square, {128, 192, 238, 255}), flat);  // normal tilted upwards
  EXPECT_LT(brightness(square, {128, 64, 238, 255}), flat);   // normal tilted downwards
  TexturedSquare plain;
  plain.material().is_unlit = false;
  EXPECT_NEAR(pixel_of(plain.seen(4), 1, 1)[1], flat, 1);
}

TEST(TexturedRender, TheTangentsOfANormalMapFollowTheTextureCoordinates) {
  TexturedSquare mirrored, turned;
  for (auto& corners : mirrored.texturing.coordinates[0]) {
    for (TextureCoordinates& uv : corners)
      uv[0] = 1 - uv[0];
  }
  // The right side of the picture is now at the upper side of the square.
  for (auto& corners : turned.texturing.coordinates[0]) {
    for (TextureCoordinates& uv : corners)
      uv = {1 - uv[1], uv[0]};
  }
  const TexturedSquare upright;
  const std::array<std::uint8_t, 4> left{64, 128, 238, 255}, right{192, 128, 238, 255},
      up{128, 192, 238, 255};
  EXPECT_NEAR(brightness(mirrored, right), brightness(upright, left), 1);
  EXPECT_NEAR(brightness(turned, right), brightness(upright, up), 1);
}

TEST(TexturedRender, ASmallerNormalScaleFlattensTheSurface) {
  TexturedSquare square;
  const std::array<std::uint8_t, 4> left{64, 128, 238, 255}, flat{128, 128, 255, 255};
  square.material().normal_scale = 0;
  EXPECT_NEAR(brightness(square, left), brightness(square, flat), 1);
}

TEST(TexturedRender, AMaskHidesWhatIsBelowItsCutoff) {
  TexturedSquare square;
  square
      .show(picture_of(2, 1,
                       [](int x, int) -> std::array<std::uint8_t, 4> {
                         return {255, 255, 255, static_cast<std::uint8_t>(x == 0 ? 255 : 100)};
                       }))
      .is_nearest = true;
  square.material().alpha_mode = AlphaMode::kMask;
  EXPECT_EQ(pixel_of(square.seen(32), 4, 4), kPureWhite);
  EXPECT_EQ(pixel_of(square.seen(32), 28, 4), (Pixel{0, 0, 0, 0}));
  square.material().alpha_cutoff = 0.3;
  EXPECT_EQ(pixel_of(square.seen(32), 28, 4), kPureWhite);
}

TEST(TexturedRender, ABlendedFaceCoversItsShareOfThePixel) {
  TexturedSquare square;
  square.material().alpha_mode = AlphaMode::kBlend;
  for (const double opacity : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
    square.material().base_colour[3] = opacity;
    EXPECT_NEAR(pixel_of(square.seen(8), 3, 3)[3], 255 * opacity, 1);
  }
}

TEST(TexturedRender, AnOpaqueMaterialIgnoresTheOpacityOfItsPicture) {
  TexturedSquare square;
  square.show(plain_picture({255, 0, 0, 0}));
  EXPECT_EQ(pixel_of(square.seen(8), 3, 3), kPureRed);
}

// White is a material's default colour. A white material must therefore look like no material.
TEST(TexturedRender, AWhiteMaterialLooksLikeNoMaterial) {
  TexturedSquare square;
  square.material().is_unlit = false;
  const Framing frame{.centre = {}, .pixel = 0.1, .width = 20, .height = 20, .toward = {0, 0, 1}};
  EXPECT_EQ(square.seen(20).pixels, render(square.mesh, frame).pixels);
  square.material().base_colour = {1, 1, 0.5, 1};
  EXPECT_NE(square.seen(20).pixels, render(square.mesh, frame).pixels);
}

TEST(TexturedRender, AMapWithoutPixelsIsIgnored) {
  TexturedSquare square;
  square.show({});
  EXPECT_EQ(pixel_of(square.seen(8), 3, 3), kPureWhite);
}

}  // namespace
}  // namespace vitrine::test
