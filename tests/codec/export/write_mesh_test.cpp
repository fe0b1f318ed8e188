// SPDX-License-Identifier: Apache-2.0
#include "codec/export/write_mesh.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>

#include "codec/export/seam_vertices.h"
#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"
#include "codec/mesh/vertex_normals.h"
#include "codec/picture/write_picture.h"
#include "support/read_export.h"

namespace vitrine {
namespace {

using test::vrml_list;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;
using vitrine::testing::grid;

// Returns a mesh with many colours. Its positions need all 24 bits of single precision.
TriangleMesh sample(bool coloured) {
  TriangleMesh mesh = grid(16);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto digits = [&](std::size_t factor) {
      return static_cast<double>(v * factor % (1u << 24)) - (1 << 23);
    };
    mesh.positions[v] = {digits(7919) / 1024, digits(104729) * 64, digits(130363)};
    const auto byte = static_cast<std::uint8_t>(v);
    const auto reversed = static_cast<std::uint8_t>(255 - v);
    if (coloured)
      mesh.attributes.colours.push_back({byte, reversed, static_cast<std::uint8_t>(v * 7)});
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

// Returns a material with a PNG picture, and texture coordinates for each face of `mesh`. Every
// edge is a seam: adjacent faces have different coordinates at their common vertices.
Texturing seams_everywhere(const TriangleMesh& mesh) {
  Texturing texturing;
  texturing.pictures = {{"a.png", write_png({2, 1, {255, 0, 0, 255, 0, 0, 255, 128}}).value()}};
  texturing.materials = {
      {.base_colour_map = TextureMap{.wrap_u = Wrap::kClamp, .wrap_v = Wrap::kClamp},
       .alpha_mode = AlphaMode::kMask,
       .alpha_cutoff = 0.25,
       .is_double_sided = true,
       .is_unlit = true}};
  texturing.face_materials.assign(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto at = static_cast<float>(f) / 64;
    texturing.coordinates[0].push_back({{{at, 0}, {at, 0.5F}, {0.5F, at}}});
  }
  return texturing;
}

std::vector<MeshFile> textured_files(const TriangleMesh& mesh, const Texturing& texturing,
                                     MeshFormat format, std::string_view stem = "cat") {
  auto files = write_textured_mesh(mesh, texturing, format, stem, {.unit = "m"});
  EXPECT_TRUE(files) << files.error().message;
  return files ? std::move(*files) : std::vector<MeshFile>(1);
}

// Reads the first file. The other files are its companions, such as pictures.
ImportedMesh read_files(const std::vector<MeshFile>& files) {
  ReadOptions options;
  for (std::size_t i = 1; i < files.size(); ++i)
    options.beside[companion_key(files[i].name)] = files[i].bytes;
  auto read = read_mesh(files[0].bytes, options);
  EXPECT_TRUE(read) << read.error().message;
  return read ? std::move(*read) : ImportedMesh{};
}

std::vector<std::string> names_of(const std::vector<MeshFile>& files) {
  std::vector<std::string> names;
  for (const MeshFile& file : files)
    names.push_back(file.name);
  return names;
}

TEST(WriteTexturedMesh, GlbHoldsTheTexture) {
  TriangleMesh mesh = grid(4);
  mesh.attributes.colours.assign(mesh.positions.size(), {1, 2, 3});
  const Texturing texturing = seams_everywhere(mesh);
  const auto files = textured_files(mesh, texturing, MeshFormat::kGlb);
  EXPECT_THAT(names_of(files), ElementsAre("cat.glb"));
  const ImportedMesh back = read_files(files);
  EXPECT_EQ(back.mesh.faces.size(), mesh.faces.size());
  EXPECT_EQ(back.texturing.coordinates[0], texturing.coordinates[0]);
  ASSERT_EQ(back.texturing.pictures.size(), 1u);
  EXPECT_EQ(back.texturing.pictures[0].bytes, texturing.pictures[0].bytes);
  const Material& material = back.texturing.materials.at(0);
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.25);
  EXPECT_TRUE(material.is_double_sided);
  EXPECT_TRUE(material.is_unlit);
  EXPECT_EQ(material.base_colour_map->wrap_u, Wrap::kClamp);
}

// Expects that the mesh read back has the same faces and picture, and the same texture coordinates
// up to rounding.
void expect_same_texture(const ImportedMesh& back, const TriangleMesh& mesh,
                         const Texturing& texturing) {
  EXPECT_EQ(back.mesh.positions, mesh.positions);
  EXPECT_EQ(back.mesh.faces, mesh.faces);
  const auto &found = back.texturing.coordinates[0], &expected = texturing.coordinates[0];
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t f = 0; f < found.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(found[f][k][0], expected[f][k][0]);
      EXPECT_NEAR(found[f][k][1], expected[f][k][1], 1e-7);
    }
  }
  ASSERT_EQ(back.texturing.materials.size(), 1u);
  const auto& map = back.texturing.materials[0].base_colour_map;
  ASSERT_TRUE(map);
  EXPECT_EQ(back.texturing.pictures.at(map->picture).bytes, texturing.pictures[0].bytes);
}

TEST(WriteTexturedMesh, PlyNamesItsPictureAndReadsBack) {
  TriangleMesh mesh = grid(4);
  mesh.attributes.colours.assign(mesh.positions.size(), {1, 2, 3});
  const Texturing texturing = seams_everywhere(mesh);
  const auto files = textured_files(mesh, texturing, MeshFormat::kPly);
  EXPECT_THAT(names_of(files), ElementsAre("cat.ply", "cat_a.png"));
  const ImportedMesh back = read_files(files);
  expect_same_texture(back, mesh, texturing);
  EXPECT_THAT(back.repairs, ElementsAre(HasSubstr("baked into vertex colours")));
}

TEST(WriteTexturedMesh, ObjNamesItsLibraryAndPicturesAndReadsBack) {
  TriangleMesh mesh = grid(4);
  mesh.attributes.colours.assign(mesh.positions.size(), {1, 2, 3});
  Texturing texturing = seams_everywhere(mesh);
  texturing.pictures.push_back({"n.png", write_png({1, 1, {128, 128, 255, 255}}).value()});
  texturing.pictures.push_back({"e.png", write_png({1, 1, {9, 9, 9, 255}}).value()});
  texturing.materials[0].normal_map = TextureMap{.picture = 1};
  texturing.materials[0].emission_map = TextureMap{.picture = 2};
  texturing.materials[0].emission = {1, 1, 1};
  const auto files = textured_files(mesh, texturing, MeshFormat::kObj);
  EXPECT_THAT(names_of(files),
              ElementsAre("cat.obj", "cat.mtl", "cat_a.png", "cat_n.png", "cat_e.png"));
  const ImportedMesh back = read_files(files);
  expect_same_texture(back, mesh, texturing);
  EXPECT_THAT(back.repairs, ElementsAre(HasSubstr("baked into vertex colours")));
  const Material& material = back.texturing.materials.at(0);
  EXPECT_EQ(material.alpha_mode, AlphaMode::kBlend) << "MTL has no cutoff";
  const auto picture = [&](const std::optional<TextureMap>& map) {
    return map ? back.texturing.pictures.at(map->picture).bytes : std::vector<std::uint8_t>();
  };
  EXPECT_EQ(picture(material.normal_map), texturing.pictures[1].bytes);
  EXPECT_EQ(picture(material.emission_map), texturing.pictures[2].bytes);
  EXPECT_EQ(material.emission, (Vec3{1, 1, 1}));
}

TEST(WriteTexturedMesh, VrmlNamesItsPictureAndHasCoordinatesForEachCorner) {
  TriangleMesh mesh = grid(4);
  mesh.attributes.colours.assign(mesh.positions.size(), {1, 2, 3});
  const Texturing texturing = seams_everywhere(mesh);
  const auto files = textured_files(mesh, texturing, MeshFormat::kVrml);
  ASSERT_THAT(names_of(files), ElementsAre("cat.wrl", "cat_a.png"));
  EXPECT_EQ(files[1].bytes, texturing.pictures[0].bytes);
  const std::string text = as_text(files[0].bytes);
  EXPECT_THAT(text, HasSubstr("texture ImageTexture {\n      url \"cat_a.png\""));
  EXPECT_THAT(text, Not(HasSubstr("color")));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  const std::string coordinates = text.substr(text.find("TextureCoordinate"));
  const auto points = vrml_list(coordinates, "point"), corners = vrml_list(text, "texCoordIndex");
  ASSERT_EQ(corners.size(), vrml_list(text, "coordIndex").size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = 2 * static_cast<std::size_t>(corners[4 * f + k]);
      EXPECT_NEAR(points.at(at), texturing.coordinates[0][f][k][0], 1e-6);
      EXPECT_NEAR(1 - points.at(at + 1), texturing.coordinates[0][f][k][1], 1e-6);
    }
  }
}

TEST(WriteTexturedMesh, NoNameCanAddAStatementToAMeshFile) {
  const TriangleMesh mesh = grid(4);
  Texturing texturing = seams_everywhere(mesh);
  texturing.pictures[0].name = "x\"\nf 1 2 3\n#.png";
  for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kVrml}) {
    const auto files = textured_files(mesh, texturing, format, "my \"cat\"\nelement face 9");
    EXPECT_EQ(files.back().name, "my__cat__element_face_9_x__f_1_2_3__.png");
    EXPECT_THAT(as_text(files[0].bytes), Not(HasSubstr("\nf 1 2 3\n")));
    if (format != MeshFormat::kVrml) {
      EXPECT_EQ(read_files(files).texturing.pictures.size(), 1u);
    }
  }
}

TEST(WriteTexturedMesh, WithoutATextureThereIsOneFileWithColours) {
  const TriangleMesh mesh = coloured_tetrahedron();
  for (const ExportFormat& row : kExportFormats) {
    const auto files = textured_files(mesh, {}, row.format);
    EXPECT_THAT(names_of(files), ElementsAre("cat." + std::string(row.extension)));
    EXPECT_EQ(files[0].bytes, write_mesh(mesh, row.format, {.unit = "m"}).value());
  }
  const Texturing texturing = seams_everywhere(mesh);
  EXPECT_EQ(textured_files(mesh, texturing, MeshFormat::kStl).size(), 1u);
}

TEST(WriteTexturedMesh, ATextureThatDoesNotFitTheMeshOrFormatIsRefused) {
  const TriangleMesh mesh = grid(4);
  Texturing texturing = seams_everywhere(mesh);
  texturing.coordinates[0].pop_back();
  EXPECT_FALSE(write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a"));
  texturing = seams_everywhere(mesh);
  texturing.materials[0].base_colour_map->picture = 1;
  EXPECT_FALSE(write_textured_mesh(mesh, texturing, MeshFormat::kGlb, "a"));
  texturing.materials[0].base_colour_map.reset();
  EXPECT_TRUE(write_textured_mesh(mesh, texturing, MeshFormat::kObj, "a"));
  EXPECT_FALSE(write_textured_mesh(mesh, texturing, MeshFormat::kPly, "a"));
  EXPECT_FALSE(write_textured_mesh(mesh, texturing, MeshFormat::kVrml, "a"));
}

// Returns the rows of three numbers that follow each `keyword` at the start of a line.
std::vector<Vec3> lines_of(const std::string& text, const std::string& keyword) {
  std::vector<Vec3> out;
  for (std::size_t at = 0; (at = text.find('\n' + keyword + ' ', at)) != text.npos; ++at) {
    std::istringstream line(text.substr(at + keyword.size() + 2));
    Vec3 v;
    line >> v.x >> v.y >> v.z;
    out.push_back(v);
  }
  return out;
}

// Reads `count` rows of three floats from a binary file. The first row is at `offset`; rows are
// `stride` bytes apart.
std::vector<Vec3> floats_at(std::span<const std::uint8_t> bytes, std::size_t offset,
                            std::size_t stride, std::size_t count) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 3> v;
    std::memcpy(v.data(), bytes.subspan(offset + i * stride).data(), sizeof v);
    out.push_back({v[0], v[1], v[2]});
  }
  return out;
}

void expect_near(const std::vector<Vec3>& found, const std::vector<Vec3>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_LT(length(found[i] - expected[i]), 1e-4) << i;
}

// Returns a tetrahedron with faces of unequal area, for tests of normals that are weighted by area.
TriangleMesh skew_tetrahedron() {
  TriangleMesh mesh = coloured_tetrahedron();
  mesh.positions[3] = {0, 0, 3};
  return mesh;
}

TEST(WriteMesh, NormalsAreThoseOfTheViewer) {
  const TriangleMesh mesh = skew_tetrahedron();
  const std::vector<Vec3> expected = unit_normals(mesh);
  const std::size_t vertices = mesh.positions.size();
  const auto glb = *write_mesh(mesh, MeshFormat::kGlb);
  EXPECT_THAT(as_text(glb), HasSubstr(R"("NORMAL":1,"COLOR_0":2)"));
  const std::size_t binary = as_text(glb).find(std::string("BIN\0", 4)) + 4;
  expect_near(floats_at(glb, binary + vertices * 12, 12, vertices), expected);
  const auto ply = *write_mesh(mesh, MeshFormat::kPly);
  EXPECT_THAT(as_text(ply), HasSubstr("property float nx\n"));
  expect_near(floats_at(ply, as_text(ply).find("end_header\n") + 11 + 12, 27, vertices), expected);
  const std::string obj = as_text(*write_mesh(mesh, MeshFormat::kObj));
  expect_near(lines_of(obj, "vn"), expected);
  const auto [a, b, c] = mesh.faces[0];
  EXPECT_THAT(obj, HasSubstr("\nf " + std::to_string(a + 1) + "//" + std::to_string(a + 1) + ' '));
  const auto vectors = vrml_list(as_text(*write_mesh(mesh, MeshFormat::kVrml)), "vector");
  ASSERT_EQ(vectors.size(), 3 * vertices);
  EXPECT_NEAR(vectors[3], expected[1].x, 1e-4);
}

TEST(WriteMesh, WithoutNormalsAFileHasNone) {
  const TriangleMesh mesh = coloured_tetrahedron();
  const auto text = [&](MeshFormat format) {
    return as_text(*write_mesh(mesh, format, {.normals = Normals::kNone}));
  };
  EXPECT_THAT(text(MeshFormat::kGlb), Not(HasSubstr("NORMAL")));
  EXPECT_THAT(text(MeshFormat::kPly), Not(HasSubstr("nx")));
  EXPECT_THAT(text(MeshFormat::kObj), Not(HasSubstr("vn")));
  EXPECT_THAT(text(MeshFormat::kVrml), Not(HasSubstr("Normal")));
}

TEST(WriteTexturedMesh, VerticesAtASeamShareTheirNormal) {
  const TriangleMesh mesh = skew_tetrahedron();
  const Texturing texturing = seams_everywhere(mesh);
  const auto expected = unit_normals(mesh);
  const std::string obj = as_text(textured_files(mesh, texturing, MeshFormat::kObj)[0].bytes);
  expect_near(lines_of(obj, "vn"), expected);
  const std::string first = std::to_string(mesh.faces[0][0] + 1);
  EXPECT_THAT(obj, HasSubstr("\nf " + first + "/1/" + first + ' '));
  const auto glb = textured_files(mesh, texturing, MeshFormat::kGlb)[0].bytes;
  EXPECT_THAT(as_text(glb), HasSubstr(R"("NORMAL":1,"TEXCOORD_0":2)"));
  const SeamVertices split = split_at_seams(mesh, texturing);
  ASSERT_GT(split.original.size(), mesh.positions.size());
  std::vector<Vec3> per_vertex;
  for (const std::uint32_t v : split.original)
    per_vertex.push_back(expected[v]);
  const std::size_t binary = as_text(glb).find(std::string("BIN\0", 4)) + 4;
  const std::size_t at = binary + split.original.size() * 12;
  expect_near(floats_at(glb, at, 12, split.original.size()), per_vertex);
}

TEST(WriteMesh, PlyAndGlbReadBackExactly) {
  for (const bool coloured : {false, true}) {
    for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kGlb}) {
      const TriangleMesh mesh = sample(coloured);
      const TriangleMesh back = read_back(mesh, format);
      EXPECT_EQ(back.positions, mesh.positions);
      EXPECT_EQ(back.faces, mesh.faces);
      EXPECT_EQ(back.attributes.colours, mesh.attributes.colours);
    }
  }
}

TEST(WriteMesh, ObjAnd3mfReadBackExactlyInSinglePrecision) {
  for (const bool coloured : {false, true}) {
    for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::k3mf}) {
      const TriangleMesh mesh = sample(coloured);
      const TriangleMesh back = read_back(mesh, format);
      EXPECT_EQ(back.faces, mesh.faces);
      EXPECT_EQ(back.attributes.colours, mesh.attributes.colours);
      ASSERT_EQ(back.positions.size(), mesh.positions.size());
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_EQ(static_cast<float>(back.positions[v].x), static_cast<float>(mesh.positions[v].x));
        EXPECT_EQ(static_cast<float>(back.positions[v].y), static_cast<float>(mesh.positions[v].y));
        EXPECT_EQ(static_cast<float>(back.positions[v].z), static_cast<float>(mesh.positions[v].z));
      }
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

TEST(WriteMesh, FarFromTheOriginDetailIsKept) {
  TriangleMesh mesh = grid(16);
  for (Vec3& p : mesh.positions)
    p = p * (1.0 / 1024) + Vec3{500'000, 5'300'000, 250};
  for (const MeshFormat format :
       {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kGlb, MeshFormat::k3mf}) {
    const TriangleMesh back = read_back(mesh, format);
    EXPECT_EQ(back.positions, mesh.positions);
    EXPECT_EQ(back.faces, mesh.faces);
  }
}

TEST(WriteMesh, StlReadsBackTheSameTriangles) {
  const TriangleMesh mesh = sample(false);
  const TriangleMesh back = read_back(mesh, MeshFormat::kStl);
  EXPECT_EQ(corner_positions(back), corner_positions(mesh));
  EXPECT_EQ(back.positions.size(), mesh.positions.size());
}

TEST(WriteMesh, VrmlHoldsTheSameMesh) {
  const TriangleMesh mesh = coloured_tetrahedron();
  const std::string text = as_text(*write_mesh(mesh, MeshFormat::kVrml));
  EXPECT_THAT(text, StartsWith("#VRML V2.0 utf8\n"));
  EXPECT_THAT(text, HasSubstr("normal Normal"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  const auto points = vrml_list(text, "point"), colours = vrml_list(text, "color");
  const auto indices = vrml_list(text, "coordIndex");
  ASSERT_EQ(points.size(), 12u);
  ASSERT_EQ(colours.size(), 12u);
  ASSERT_EQ(indices.size(), 16u);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(mesh.positions[v], (Vec3{points[3 * v], points[3 * v + 1], points[3 * v + 2]}));
    EXPECT_NEAR(colours[3 * v + 1] * 255, mesh.attributes.colours[v][1], 1e-4);
  }
  for (std::size_t f = 0; f < 4; ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(indices[4 * f + k], mesh.faces[f][k]);
    EXPECT_EQ(indices[4 * f + 3], -1);
  }
}

TEST(WriteMesh, DracoHoldsTheSameSurfaceWithin24Bits) {
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
  // Each decoded point must have exactly the colour of a vertex and lie within one quantisation
  // step of it.
  double widest = 0;
  for (const Vec3& p : mesh.positions)
    widest = std::max(widest, std::abs(p.y));
  const double step = 2 * widest / ((1 << 24) - 1);
  for (draco::PointIndex point(0); point < back.num_points(); ++point) {
    Colour colour;
    std::array<float, 3> position;
    colours->GetMappedValue(point, colour.data());
    positions->GetMappedValue(point, position.data());
    const auto is_here = [&](std::size_t v) {
      const Vec3& p = mesh.positions[v];
      return mesh.attributes.colours[v] == colour && std::abs(p.x - position[0]) <= step &&
             std::abs(p.y - position[1]) <= step && std::abs(p.z - position[2]) <= step;
    };
    bool found = false;
    for (std::size_t v = 0; v < mesh.attributes.colours.size() && !found; ++v)
      found = is_here(v);
    EXPECT_TRUE(found) << "decoded point " << point.value();
  }
}

TEST(WriteMesh, GlbStatesTheBoundsAndAlignsItsChunks) {
  const std::string file = as_text(*write_mesh(coloured_tetrahedron(), MeshFormat::kGlb));
  EXPECT_EQ(file.size() % 4, 0u);
  EXPECT_THAT(file, HasSubstr(R"("min":[0,0,0],"max":[1,1,1])"));
}

TEST(WriteMesh, StlDoesNotStartWithSolid) {
  EXPECT_THAT(as_text(*write_mesh(grid(1), MeshFormat::kStl)), Not(StartsWith("solid")));
}

TEST(WriteMesh, KnowsExtensionsInEitherCaseWithOrWithoutDot) {
  EXPECT_EQ(format_of_extension(".PLY"), MeshFormat::kPly);
  EXPECT_EQ(format_of_extension("wrl"), MeshFormat::kVrml);
  EXPECT_EQ(format_of_extension(".drc"), MeshFormat::kDrc);
  EXPECT_EQ(format_of_extension(".3MF"), MeshFormat::k3mf);
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
