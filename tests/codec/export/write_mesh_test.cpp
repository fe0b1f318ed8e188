// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;
using vitrine::testing::grid;

// A mesh whose positions are exact in single precision but take all its digits, in every colour.
TriangleMesh sample(bool coloured) {
  TriangleMesh mesh = grid(16);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    p = {static_cast<float>(p.x / 3 - 2e-7), static_cast<float>(p.y * 1e9 / 7),
         static_cast<float>(0.1 * static_cast<double>(v % 5))};
    const auto byte = static_cast<std::uint8_t>(v);
    const auto reversed = static_cast<std::uint8_t>(255 - v);
    if (coloured) mesh.colours.push_back({byte, reversed, static_cast<std::uint8_t>(v * 7)});
  }
  return mesh;
}

TriangleMesh read_back(const TriangleMesh& mesh, MeshFormat format) {
  const auto bytes = write_mesh(mesh, format);
  EXPECT_TRUE(bytes.has_value());
  auto read = read_mesh(*bytes);
  EXPECT_TRUE(read.has_value()) << read.error().message;
  EXPECT_THAT(read->repairs, IsEmpty());
  return std::move(read->mesh);
}

TEST(WriteMesh, PlyGlbAndObjReadBackExactly) {
  for (const bool coloured : {false, true}) {
    for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kGlb, MeshFormat::kObj}) {
      const TriangleMesh mesh = sample(coloured);
      const TriangleMesh back = read_back(mesh, format);
      EXPECT_EQ(back.positions, mesh.positions);
      EXPECT_EQ(back.faces, mesh.faces);
      EXPECT_EQ(back.colours, mesh.colours);
    }
  }
}

std::vector<std::array<double, 9>> corner_positions(const TriangleMesh& mesh) {
  std::vector<std::array<double, 9>> out;
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    out.push_back({p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z});
  }
  return out;
}

TEST(WriteMesh, StlReadsBackTheSameTriangles) {
  const TriangleMesh mesh = sample(false);
  const TriangleMesh back = read_back(mesh, MeshFormat::kStl);
  EXPECT_EQ(corner_positions(back), corner_positions(mesh));
  EXPECT_EQ(back.positions.size(), mesh.positions.size());
}

// The numbers between `[` and `]` after a keyword.
std::vector<double> vrml_list(const std::string& text, const std::string& keyword) {
  std::size_t begin = text.find(keyword + " [");
  EXPECT_NE(begin, text.npos) << keyword;
  begin += keyword.size() + 2;
  std::string body = text.substr(begin, text.find(']', begin) - begin);
  std::replace(body.begin(), body.end(), ',', ' ');
  std::istringstream words(body);
  return {std::istream_iterator<double>(words), {}};
}

TEST(WriteMesh, VrmlHoldsTheSameMesh) {
  const TriangleMesh mesh = coloured_tetrahedron();
  const std::string text = as_text(*write_mesh(mesh, MeshFormat::kVrml));
  EXPECT_THAT(text, StartsWith("#VRML V2.0 utf8\n"));
  EXPECT_THAT(text, HasSubstr("creaseAngle"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  const auto points = vrml_list(text, "point"), colours = vrml_list(text, "color");
  const auto indices = vrml_list(text, "coordIndex");
  ASSERT_EQ(points.size(), 12u);
  ASSERT_EQ(colours.size(), 12u);
  ASSERT_EQ(indices.size(), 16u);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(mesh.positions[v], (Vec3{points[3 * v], points[3 * v + 1], points[3 * v + 2]}));
    EXPECT_NEAR(colours[3 * v + 1] * 255, mesh.colours[v][1], 1e-4);
  }
  for (std::size_t f = 0; f < 4; ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(indices[4 * f + k], mesh.faces[f][k]);
    EXPECT_EQ(indices[4 * f + 3], -1);
  }
}

TEST(WriteMesh, DracoHoldsTheSameSurfaceWithinSixteenBits) {
  const TriangleMesh mesh = sample(true);
  const auto bytes = write_mesh(mesh, MeshFormat::kDrc);
  ASSERT_TRUE(bytes.has_value());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  ASSERT_TRUE(decoded.ok());
  const auto& back = *decoded.value();
  ASSERT_EQ(back.num_faces(), mesh.faces.size());
  ASSERT_EQ(back.num_points(), mesh.positions.size());
  const auto* positions = back.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const auto* colours = back.GetNamedAttribute(draco::GeometryAttribute::COLOR);
  ASSERT_NE(colours, nullptr);
  // Green falls from 255 as the vertex number rises: with red and blue it names the vertex.
  std::set<Colour> seen;
  const double step = 16e9 / 7 / 65535;
  for (draco::PointIndex point(0); point < back.num_points(); ++point) {
    Colour colour;
    std::array<float, 3> position;
    colours->GetMappedValue(point, colour.data());
    positions->GetMappedValue(point, position.data());
    seen.insert(colour);
    const auto near = [&](std::size_t v) {
      return mesh.colours[v] == colour && std::abs(mesh.positions[v].y - position[1]) <= step;
    };
    bool found = false;
    for (std::size_t v = 0; v < mesh.colours.size() && !found; ++v)
      found = near(v);
    EXPECT_TRUE(found) << point.value();
  }
  EXPECT_EQ(seen.size(), 256u);
}

TEST(WriteMesh, GlbStatesTheBoundsAndAlignsItsChunks) {
  const std::string file = as_text(*write_mesh(coloured_tetrahedron(), MeshFormat::kGlb));
  EXPECT_EQ(file.size() % 4, 0u);
  EXPECT_THAT(file, HasSubstr(R"("min":[0,0,0],"max":[1,1,1])"));
}

TEST(WriteMesh, StlDoesNotStartWithSolid) {
  EXPECT_THAT(as_text(*write_mesh(grid(1), MeshFormat::kStl)), ::testing::Not(StartsWith("solid")));
}

TEST(WriteMesh, KnowsExtensionsInEitherCaseWithOrWithoutDot) {
  EXPECT_EQ(format_of_extension(".PLY"), MeshFormat::kPly);
  EXPECT_EQ(format_of_extension("wrl"), MeshFormat::kVrml);
  EXPECT_EQ(format_of_extension(".drc"), MeshFormat::kDrc);
  EXPECT_EQ(format_of_extension("txt"), std::nullopt);
  EXPECT_EQ(format_of_extension(""), std::nullopt);
}

TEST(WriteMesh, RefusesWhatNoFormatCanHold) {
  EXPECT_FALSE(write_mesh({}, MeshFormat::kPly).has_value());
  TriangleMesh mesh = coloured_tetrahedron();
  mesh.positions[2].x = 1e39;
  EXPECT_THAT(write_mesh(mesh, MeshFormat::kObj).error().message, HasSubstr("vertex 2"));
  mesh.positions[2].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(write_mesh(mesh, MeshFormat::kGlb).has_value());
  mesh = coloured_tetrahedron();
  mesh.faces[3][0] = 4;
  EXPECT_THAT(write_mesh(mesh, MeshFormat::kStl).error().message, HasSubstr("face 3"));
}

}  // namespace
}  // namespace vitrine
