// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/appearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.h"

namespace vitrine::test {
namespace {

// A tube with a picture wrapped once around it. A thin tube takes less time to render.
struct TexturedTube {
  TriangleMesh mesh = tube(64, 20);
  Texturing texturing;
  std::vector<Picture> pictures;

  explicit TexturedTube(double shift = 0) : pictures(1) {
    for (Vec3& p : mesh.positions)
      p = {0.2 * p.x, 0.2 * p.y, p.z};
    texturing.face_materials.assign(mesh.faces.size(), 0);
    texturing.materials.push_back({.base_colour_map = TextureMap{}});
    texturing.materials[0].base_colour_map->transform.offset = {shift, 0};
    for (const Triangle& face : mesh.faces)
      texturing.coordinates[0].push_back({at(face[0], face), at(face[1], face), at(face[2], face)});
    Picture& picture = pictures[0];
    picture = {256, 64, {}};
    for (std::uint32_t y = 0; y < picture.height; ++y) {
      for (std::uint32_t x = 0; x < picture.width; ++x)
        picture.pixels.insert(picture.pixels.end(), {wave(x, 8), wave(y, 2), wave(x + y, 4), 255});
    }
  }

  Expected<Appearance> compared_with(const TexturedTube& reference) const {
    const Textures own(texturing, pictures);
    const Textures others(reference.texturing, reference.pictures);
    return compare_appearance({.mesh = mesh, .textures = &own},
                              {.mesh = reference.mesh, .textures = &others});
  }

 private:
  // Returns the texture coordinates of a face's corner. At the seam between the last and the first
  // column of faces, u is 1 instead of 0.
  static TextureCoordinates at(std::uint32_t vertex, const Triangle& face) {
    const bool wraps =
        vertex % 64 == 0 && std::ranges::any_of(face, [](std::uint32_t v) { return v % 64 == 63; });
    const auto column = static_cast<float>(wraps ? 64 : vertex % 64);
    return {column / 64, static_cast<float>(vertex / 64) / 19};
  }

  static std::uint8_t wave(std::uint32_t x, double waves) {
    return static_cast<std::uint8_t>(128 + 100 * std::sin(x * waves * 2 * std::acos(-1.0) / 256));
  }
};

TEST(Appearance, AModelLooksLikeItself) {
  const TexturedTube model;
  const auto found = model.compared_with(model);
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_FALSE(found->psnr.has_value());
  EXPECT_NEAR(found->ssim, 1, 1e-12);
}

TEST(Appearance, VerticesThatAreRepeatedForEachFaceChangeNothing) {
  const TriangleMesh shared = sheet(20, 20);
  TriangleMesh repeated;
  for (const Triangle& face : shared.faces) {
    const auto first = static_cast<std::uint32_t>(repeated.positions.size());
    for (const std::uint32_t v : face)
      repeated.positions.push_back(shared.positions[v]);
    repeated.faces.push_back({first, first + 1, first + 2});
  }
  const auto found = compare_appearance({.mesh = repeated}, {.mesh = shared});
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->psnr.has_value());
}

TEST(Appearance, TheFurtherATextureIsShiftedTheLowerAreTheFigures) {
  const TexturedTube reference;
  double psnr = 100, ssim = 1;
  for (const double shift : {0.001, 0.008, 0.05}) {
    const auto found = TexturedTube(shift).compared_with(reference);
    ASSERT_TRUE(found.has_value() && found->psnr.has_value());
    EXPECT_LT(*found->psnr, psnr) << shift;
    EXPECT_LT(found->ssim, ssim) << shift;
    psnr = *found->psnr;
    ssim = found->ssim;
  }
  // Both models have the same bounds, so swapping them must not change the result.
  const auto exchanged = reference.compared_with(TexturedTube(0.05));
  ASSERT_TRUE(exchanged.has_value());
  EXPECT_EQ(exchanged->psnr, psnr);
  EXPECT_EQ(exchanged->ssim, ssim);
}

TEST(Appearance, TheViewsAreThoseOfTheSecondModel) {
  const TriangleMesh whole = tube(64, 20);
  TriangleMesh half = whole;
  half.faces.resize(half.faces.size() / 2);
  const auto missing = compare_appearance({.mesh = half}, {.mesh = whole});
  const auto additional = compare_appearance({.mesh = whole}, {.mesh = half});
  ASSERT_TRUE(missing.has_value() && additional.has_value());
  EXPECT_NE(missing->psnr, additional->psnr);
  EXPECT_LT(missing->ssim, 1);
}

TEST(Appearance, AMeshWithoutASurfaceIsAnError) {
  const TriangleMesh mesh = sheet(4, 4), empty;
  TriangleMesh damaged = mesh, needle = mesh;
  damaged.faces[0][1] = 99;
  needle.faces = {{0, 1, 1}};
  const auto fault = [](const TriangleMesh& a, const TriangleMesh& b) {
    const auto found = compare_appearance({.mesh = a}, {.mesh = b});
    return found ? std::string() : found.error().message;
  };
  EXPECT_EQ(fault(empty, mesh), "mesh A has no face; give a mesh with a surface");
  EXPECT_EQ(fault(mesh, empty), "mesh B has no face; give a mesh with a surface");
  EXPECT_EQ(fault(damaged, mesh),
            "mesh A: face 0 names a vertex that does not exist; export it again");
  EXPECT_EQ(fault(needle, needle), "no face of A or B is visible; give meshes with a surface");
}

}  // namespace
}  // namespace vitrine::test
