// SPDX-License-Identifier: Apache-2.0
// Tests that materials and texture coordinates stay with the corners of their faces, from the
// reader to the repaired mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "codec/repair/raw_mesh.h"
#include "codec/repair/repair.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kSide = 12;
constexpr std::uint16_t kMaterials = 7;

// Returns a number that identifies the position. Coordinates must be integers from 0 to 15.
float code_of(const Vec3& p) {
  return static_cast<float>(p.x + 16 * p.y + 256 * p.z);
}

Material mapped(std::uint8_t set) {
  return {.base_colour_map = TextureMap{.coordinates = set}};
}

// Builds random meshes that need every kind of repair. Texture coordinates identify their corner: u
// is the code of the corner's position. In set 0, v is the number of the face; in set 1, v is the
// number of the vertex.
class RandomMesh {
 public:
  explicit RandomMesh(std::uint32_t seed) : random_(seed) {}

  RawMesh make() {
    mesh_.has_seams = chance(2);
    mesh_.is_baked = false;
    mesh_.materials.assign(kMaterials, mapped(0));
    mesh_.materials[3] = mapped(1);
    mesh_.pictures.resize(1);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x)
        add_cell(x, y);
    }
    for (int i = 0; i < 10; ++i)
      add_face({point(below(kSide), below(kSide), below(4)), point(below(kSide), below(kSide), 1),
                point(below(kSide), below(kSide), 0)});
    return std::move(mesh_);
  }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  bool chance(int n) { return below(n) == 0; }

  // Returns a vertex at this position. It is an existing vertex, or a copy as on the border of a
  // texture chart.
  std::uint32_t point(int x, int y, int z) {
    auto& there = vertices_[static_cast<std::size_t>(x + 16 * y + 256 * z)];
    if (!there.empty() && !chance(4))
      return there[static_cast<std::size_t>(below(static_cast<int>(there.size())))];
    const auto v = static_cast<std::uint32_t>(mesh_.positions.size());
    const Vec3 p{double(x), double(y), double(z)};
    mesh_.positions.push_back(p);
    mesh_.vertex_coordinates[1].push_back({code_of(p), static_cast<float>(v)});
    there.push_back(v);
    return v;
  }

  // Adds a unit square as a polygon or as triangles. Some faces are added twice, and some are
  // degenerate.
  void add_cell(int x, int y) {
    std::vector<std::uint32_t> square{point(x, y, 0), point(x + 1, y, 0), point(x + 1, y + 1, 0),
                                      point(x, y + 1, 0)};
    if (chance(8)) std::reverse(square.begin(), square.end());
    if (chance(3)) return add_face(square);
    add_face({square[0], square[1], square[2]});
    add_face({square[0], square[2], square[3]});
    if (chance(6)) add_face({square[2], square[0], square[1]});
    if (chance(6)) add_face({square[0], square[1], square[1]});
    if (chance(6)) add_face({square[0], square[1], point(x, y, 3)});
  }

  void add_face(const std::vector<std::uint32_t>& corners) {
    const auto number = mesh_.face_count();
    std::vector<TextureCoordinates> at_corners;
    for (const std::uint32_t v : corners)
      at_corners.push_back({code_of(mesh_.positions[v]), static_cast<float>(number)});
    mesh_.use_material(static_cast<std::uint16_t>(number * number % kMaterials));
    mesh_.add_face(corners, 0, at_corners);
  }

  std::mt19937 random_;
  RawMesh mesh_;
  std::array<std::vector<std::uint32_t>, 1024> vertices_;
};

// Checks every face by the numbers that RandomMesh has stored in the texture coordinates.
void expect_corners_kept(const TriangleMesh& mesh, const Texturing& texturing) {
  ASSERT_EQ(texturing.face_materials.size(), mesh.faces.size());
  for (const auto& set : texturing.coordinates)
    ASSERT_EQ(set.size(), mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto number = static_cast<std::uint64_t>(texturing.coordinates[0][f][0][1]);
    EXPECT_EQ(texturing.face_materials[f], number * number % kMaterials) << f;
    for (std::size_t k = 0; k < 3; ++k) {
      const float code = code_of(mesh.positions[mesh.faces[f][k]]);
      EXPECT_EQ(texturing.coordinates[0][f][k][0], code) << f;
      EXPECT_EQ(texturing.coordinates[0][f][k][1], static_cast<float>(number)) << f;
      EXPECT_EQ(texturing.coordinates[1][f][k][0], code) << f;
    }
  }
}

TEST(Texturing, StaysWithTheCornersOfRandomMeshes) {
  std::set<std::string> kinds;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto imported = RandomMesh(seed).make().finish({});
    ASSERT_TRUE(imported.has_value()) << imported.error().message;
    expect_corners_kept(imported->mesh, imported->texturing);
    const auto repaired = repair(*std::move(imported));
    ASSERT_TRUE(repaired.has_value());
    expect_corners_kept(repaired->mesh, repaired->texturing);
    for (const std::string& line : repaired->repairs) {
      for (const char* kind :
           {"welded", "degenerate", "duplicate", "reversed", "non-manifold", "fans"})
        if (line.find(kind) != line.npos) kinds.insert(kind);
    }
  }
  EXPECT_EQ(kinds.size(), 6u) << "every kind of repair was needed";
}

RawMesh lone_triangle() {
  RawMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  return mesh;
}

TEST(Texturing, IsEmptyWithoutMaterials) {
  RawMesh mesh = lone_triangle();
  mesh.use_material(1);
  mesh.vertex_coordinates[0].resize(3);
  mesh.add_face(std::array{0u, 1u, 2u}, 0, std::array<TextureCoordinates, 3>{});
  const auto imported = *std::move(mesh).finish({});
  EXPECT_TRUE(imported.texturing.empty());
  EXPECT_THAT(imported.texturing.face_materials, IsEmpty());
  EXPECT_THAT(imported.texturing.coordinates[0], IsEmpty());
}

TEST(Texturing, SetsThatNoMapUsesAreDroppedAndMissingOnesAreZero) {
  RawMesh mesh = lone_triangle();
  mesh.materials = {mapped(1)};
  mesh.vertex_coordinates[0] = {{1, 1}, {2, 2}, {3, 3}};
  mesh.add_triangle({0, 1, 2});
  const auto imported = *std::move(mesh).finish({});
  EXPECT_THAT(imported.texturing.coordinates[0], IsEmpty());
  const std::array<TextureCoordinates, 3> zeros{};
  EXPECT_THAT(imported.texturing.coordinates[1], ElementsAre(zeros));
}

TEST(Texturing, CoordinatesThatAreNotFiniteBecomeZeroAndAreReported) {
  RawMesh mesh = lone_triangle();
  mesh.materials = {mapped(0)};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  mesh.vertex_coordinates[0] = {{nan, 1}, {2, -infinity}, {3, -3e38F}};
  mesh.add_triangle({0, 1, 2});
  const auto imported = *std::move(mesh).finish({});
  const std::array<TextureCoordinates, 3> expected{{{0, 1}, {2, 0}, {3, -3e38F}}};
  EXPECT_THAT(imported.texturing.coordinates[0], ElementsAre(expected));
  EXPECT_THAT(imported.repairs, Contains(HasSubstr("2 texture coordinates without finite values")));
}

}  // namespace
}  // namespace vitrine
