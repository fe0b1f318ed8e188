// SPDX-License-Identifier: Apache-2.0
#include "codec/render/render.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/picture/decode_picture.h"
#include "codec/picture/write_picture.h"

namespace vitrine {
namespace {

constexpr Colour kRed = {200, 20, 20}, kGreen = {20, 200, 20};

// Adds a square whose centre is on the z axis. The square is perpendicular to the axis and faces
// +z.
void add_square(TriangleMesh& mesh, double half, double z, const Colour& colour) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {Vec3{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}})
    mesh.positions.push_back(p);
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
  mesh.attributes.colours.insert(mesh.attributes.colours.end(), 4, colour);
}

TriangleMesh square() {
  TriangleMesh mesh;
  add_square(mesh, 1, 0, kGreen);
  return mesh;
}

const std::uint8_t* pixel(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  return &picture.pixels[4 * (std::size_t{y} * picture.width + x)];
}

const std::uint8_t* middle(const Picture& picture) {
  return pixel(picture, picture.width / 2, picture.height / 2);
}

TEST(Render, TheModelIsOpaqueInTheMiddleAndNothingIsAroundIt) {
  const TriangleMesh mesh = square();
  const Picture picture = render(mesh, frame_around(mesh, 64));
  ASSERT_EQ(picture.pixels.size(), 4u * picture.width * picture.height);
  EXPECT_EQ(middle(picture)[3], 255);
  for (std::uint32_t x = 0; x < picture.width; ++x) {
    EXPECT_EQ(pixel(picture, x, 0)[3], 0);
    EXPECT_EQ(pixel(picture, x, picture.height - 1)[3], 0);
  }
}

TEST(Render, WhatIsNearerHidesWhatIsBehindInEitherOrder) {
  for (const bool red_first : {true, false}) {
    TriangleMesh mesh;
    if (red_first) add_square(mesh, 1, 0.5, kRed);
    add_square(mesh, 1, -0.5, kGreen);
    if (!red_first) add_square(mesh, 1, 0.5, kRed);
    const Picture picture = render(mesh, frame_around(mesh, 64));
    EXPECT_GT(middle(picture)[0], middle(picture)[1]) << red_first;
  }
}

TEST(Render, AFaceLooksTheSameFromBothSides) {
  TriangleMesh mesh = square();
  const Framing frame = frame_around(mesh, 64);
  const Picture front = render(mesh, frame);
  for (Triangle& f : mesh.faces)
    std::swap(f[1], f[2]);
  EXPECT_EQ(render(mesh, frame).pixels, front.pixels);
}

TEST(Render, TheFrameKeepsTheShapeButForVeryThinOnes) {
  TriangleMesh mesh;
  add_square(mesh, 1, 0, kRed);
  for (Vec3& p : mesh.positions)
    p.y *= 0.7;
  const Framing frame = frame_around(mesh, 100);
  EXPECT_EQ(frame.width, 100u);
  EXPECT_GT(frame.height, 60u);
  EXPECT_LT(frame.height, 90u);
  for (Vec3& p : mesh.positions)
    p.y = 0;
  EXPECT_EQ(frame_around(mesh, 100).height, 50u);
}

TEST(Render, AMeshWithoutExtentGivesAnEmptyPicture) {
  const TriangleMesh mesh{.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, .faces = {{0, 1, 2}}};
  const Picture picture = render(mesh, frame_around(mesh, 16));
  EXPECT_EQ(std::ranges::count(picture.pixels, 0), std::ssize(picture.pixels));
}

TEST(Render, APngFileHoldsThePictureExactly) {
  const TriangleMesh mesh = square();
  const Picture picture = render(mesh, frame_around(mesh, 64));
  const auto file = write_png(picture);
  ASSERT_TRUE(file.has_value()) << file.error().message;
  const auto image = decode_picture(*file, 1 << 20);
  ASSERT_TRUE(image.has_value()) << image.error().message;
  EXPECT_EQ(image->width, picture.width);
  EXPECT_EQ(image->height, picture.height);
  EXPECT_EQ(image->pixels, picture.pixels);
}

TEST(Render, APictureWithoutPixelsIsRefused) {
  const auto file = write_png({});
  ASSERT_FALSE(file.has_value());
  EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace vitrine
