// SPDX-License-Identifier: Apache-2.0
// Tests which materials, pictures and texture coordinates a mesh keeps from OBJ and PLY files.
#include "codec/import/reading.h"
#include "codec/picture/bitmaps.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using vitrine::testing::as_bytes;
using vitrine::testing::as_text;
using vitrine::testing::expect_counts_and_steps;
using vitrine::testing::png_of;
using vitrine::testing::red_and_blue;

using FacePlaces = std::array<TextureCoordinates, 3>;

ImportedMesh read_carried(const std::string& text,
                          const std::map<std::string, std::string>& files) {
  Companions beside;
  for (const auto& [name, contents] : files)
    beside[name] = as_bytes(contents);
  auto result = read_mesh(as_bytes(text), {.beside = beside});
  EXPECT_TRUE(result.has_value()) << result.error().message;
  if (result) expect_counts_and_steps(result->repairs);
  return result ? *std::move(result) : ImportedMesh{};
}

const std::string kSquare =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 0.75\n";

TEST(ObjTexturing, CoordinatesFollowTheCornersOfPolygonsAndTheirVAxisIsTurned) {
  const auto result =
      read_carried(kSquare + "f 1 2 3\nusemtl a\nf 1/1 2/2 3/3 4/4\nf 1/-1 3/-2 4\n",
                   {{"a.mtl", "newmtl a\nmap_Kd p.png\n"}, {"p.png", red_and_blue()}})
          .texturing;
  EXPECT_THAT(result.face_materials, ElementsAre(0, 1, 1, 1));
  EXPECT_FALSE(result.materials.at(0).base_colour_map) << "of the face before usemtl";
  ASSERT_TRUE(result.materials.at(1).base_colour_map);
  EXPECT_EQ(result.materials.at(1).name, "a");
  EXPECT_EQ(as_text(result.pictures.at(0).bytes), red_and_blue());
  EXPECT_THAT(result.coordinates[0],
              ElementsAre(FacePlaces{}, FacePlaces{{{0, 0.25}, {1, 0.25}, {0, 1}}},
                          FacePlaces{{{0, 1}, {1, 1}, {1, 0.25}}},
                          FacePlaces{{{0, 1}, {1, 0.25}, {0, 0.25}}}));
}

TEST(ObjTexturing, StatementsOfTheLibraryBecomeAMaterial) {
  const std::string library =
      "newmtl a\nKd 1 0 0\nd 0.5\nPm 0.25\nPr 0.75\nKe 2 0 1\nmap_Kd p.png\nnorm n.png\n"
      "map_Ke p.png\nmap_Ks s.png\ndisp h.png\nnewmtl b\nKd 1 0 0\nTr 0.25\n"
      "newmtl c\nmap_Kd p.png\nmap_d p.png\n";
  const auto result = read_carried(
      kSquare + "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1 3 4\nusemtl c\nf 1/1 3/3 4/4\n",
      {{"a.mtl", library}, {"p.png", red_and_blue()}, {"n.png", png_of({128, 128, 255}, 1)}});
  ASSERT_THAT(result.texturing.materials, SizeIs(3));
  const Material &a = result.texturing.materials[0], &b = result.texturing.materials[1];
  EXPECT_THAT(a.base_colour, ElementsAre(1, 1, 1, 0.5)) << "the picture goes before Kd";
  EXPECT_EQ(a.metallic, 0.25);
  EXPECT_EQ(a.roughness, 0.75);
  EXPECT_EQ(a.emission, (Vec3{2, 0, 1}));
  EXPECT_EQ(a.alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(a.base_colour_map->picture, a.emission_map->picture);
  EXPECT_NE(a.base_colour_map->picture, a.normal_map->picture);
  EXPECT_THAT(b.base_colour, ElementsAre(1, 0, 0, 0.75));
  EXPECT_EQ(result.texturing.materials[2].alpha_mode, AlphaMode::kBlend);
  EXPECT_THAT(result.repairs,
              Contains("2 kinds of material maps not carried: disp, map_Ks; bake them into the "
                       "diffuse map (map_Kd), or into a normal map (norm)"));
}

TEST(ObjTexturing, ABumpMapIsCarriedIfItShowsNormals) {
  const std::string obj = kSquare + "usemtl a\nf 1/1 2/2 3/3\n";
  const std::string library = "newmtl a\nPm 1\nmap_Bump -bm 1 b.png\n";
  const auto normals =
      read_carried(obj, {{"a.mtl", library}, {"b.png", png_of({120, 130, 250, 128, 128, 255}, 2)}});
  EXPECT_TRUE(normals.texturing.materials.at(0).normal_map);
  const auto heights = read_carried(obj, {{"a.mtl", library}, {"b.png", png_of({9, 9, 9}, 1)}});
  EXPECT_FALSE(heights.texturing.materials.at(0).normal_map);
  EXPECT_THAT(heights.repairs, Contains(HasSubstr("material maps not carried: map_Bump")));
}

TEST(ObjTexturing, IsEmptyWithoutPicturesOrLibrary) {
  const std::string obj = kSquare + "usemtl a\nf 1/1 2/2 3/3\n";
  EXPECT_TRUE(read_carried(obj, {}).texturing.empty());
  EXPECT_TRUE(read_carried(obj, {{"a.mtl", "newmtl a\nKd 1 0 0\n"}}).texturing.empty());
  const auto missing = read_carried(obj, {{"a.mtl", "newmtl a\nmap_Kd p.png\n"}});
  EXPECT_TRUE(missing.texturing.empty());
  EXPECT_THAT(missing.repairs, Contains(HasSubstr("'p.png' not carried: it is not beside")));
}

TEST(ObjTexturing, SeveralPathsOfAFileAreOnePicture) {
  const std::string obj =
      kSquare + "mtllib a.mtl\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n";
  const std::string library = "newmtl a\nmap_Kd x/p.png\nnewmtl b\nmap_Kd y\\P.png\n";
  const auto intact = read_carried(obj, {{"a.mtl", library}, {"p.png", red_and_blue()}});
  EXPECT_THAT(intact.texturing.pictures, SizeIs(1));
  EXPECT_THAT(intact.repairs,
              Contains("1 texture map baked into vertex colours; no step is needed"));
  const auto damaged =
      read_carried(obj, {{"a.mtl", library}, {"p.png", red_and_blue().substr(0, 40)}});
  EXPECT_TRUE(damaged.texturing.empty());
  EXPECT_THAT(damaged.repairs, Contains(HasSubstr("texture map 'x/p.png' not carried")));
  EXPECT_THAT(damaged.repairs, Not(Contains(HasSubstr("P.png'"))));
}

TEST(ObjTexturing, ADamagedPictureIsNotCarried) {
  const auto result = read_carried(
      kSquare + "usemtl a\nf 1/1 2/2 3/3\n",
      {{"a.mtl", "newmtl a\nmap_Kd p.png\n"}, {"p.png", red_and_blue().substr(0, 40)}});
  EXPECT_TRUE(result.texturing.empty());
}

// Returns a PLY with two faces and four vertices.
std::string textured_ply(const std::string& textures, const std::string& vertex,
                         const std::string& face, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + textures +
         "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + vertex +
         "element face 2\nproperty list uchar int vertex_indices\n" + face + "end_header\n" + body;
}

const std::string kPlyVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const std::string kTwoTextures = "comment TextureFile a.png\ncomment TextureFile b.png\n";

TEST(PlyTexturing, EachTextureIsAMaterialThatTexnumberChooses) {
  const auto result =
      read_carried(textured_ply(kTwoTextures, "",
                                "property list uchar float texcoord\nproperty int texnumber\n",
                                kPlyVertices + "4 0 1 2 3 8 0 0 1 0 1 0.75 0 0.75 1\n"
                                               "3 0 2 3 6 0 0 1 1 0 1 -1\n"),
                   {{"a.png", red_and_blue()}, {"b.png", png_of({1, 2, 3}, 1)}})
          .texturing;
  EXPECT_THAT(result.face_materials, ElementsAre(2, 1, 1)) << "polygons follow the triangles";
  EXPECT_EQ(result.materials.at(1).base_colour_map->picture, 1u);
  EXPECT_FALSE(result.materials.at(2).base_colour_map) << "texnumber -1";
  EXPECT_THAT(result.coordinates[0], ElementsAre(FacePlaces{{{0, 1}, {1, 0}, {0, 0}}},
                                                 FacePlaces{{{0, 1}, {1, 1}, {1, 0.25}}},
                                                 FacePlaces{{{0, 1}, {1, 0.25}, {0, 0.25}}}));
}

TEST(PlyTexturing, CoordinatesOfVerticesAreThoseOfTheirCorners) {
  const std::pair<const char*, const char*> names[] = {
      {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
  for (const auto& [u, v] : names) {
    const auto result =
        read_carried(
            textured_ply("comment TextureFile a.png\n",
                         "property float " + std::string(u) + "\nproperty float " + v + "\n", "",
                         "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 0.75\n0 1 0 0 0.75\n"
                         "3 0 1 2\n3 0 2 3\n"),
            {{"a.png", red_and_blue()}})
            .texturing;
    EXPECT_THAT(result.coordinates[0], ElementsAre(FacePlaces{{{0, 1}, {1, 1}, {1, 0.25}}},
                                                   FacePlaces{{{0, 1}, {1, 0.25}, {0, 0.25}}}));
    EXPECT_THAT(result.face_materials, ElementsAre(0, 0));
  }
}

TEST(PlyTexturing, ATgaIsKeptAsPng) {
  const auto read = read_carried(
      textured_ply("comment TextureFile a.tga\n", "", "property list uchar float texcoord\n",
                   kPlyVertices + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 0 1 1\n"),
      {{"a.tga", vitrine::testing::tga_of({255, 0, 0, 0, 0, 255}, 2)}});
  EXPECT_TRUE(as_text(read.texturing.pictures.at(0).bytes).starts_with("\x89PNG"));
  EXPECT_THAT(read.repairs, Contains(HasSubstr("1 texture map kept as PNG")));
}

TEST(PlyTexturing, AListOfTheWrongLengthGivesZeros) {
  const auto result =
      read_carried(
          textured_ply("comment TextureFile a.png\n", "", "property list uchar float texcoord\n",
                       kPlyVertices + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 3 1 1 1\n"),
          {{"a.png", red_and_blue()}})
          .texturing;
  EXPECT_THAT(result.coordinates[0],
              ElementsAre(FacePlaces{{{0, 1}, {1, 1}, {1, 0}}}, FacePlaces{}));
}

TEST(PlyTexturing, NoNoteSaysThatACarriedPictureIsNotCarried) {
  const std::string colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const auto coloured = read_carried(
      textured_ply("comment TextureFile a.png\n", colours, "property list uchar float texcoord\n",
                   "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n"
                   "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n"),
      {{"a.png", red_and_blue()}});
  EXPECT_THAT(coloured.texturing.pictures, SizeIs(1));
  EXPECT_THAT(coloured.repairs, ElementsAre());
  const auto several = read_carried(
      textured_ply(kTwoTextures, "", "property list uchar float texcoord\nproperty int texnumber\n",
                   kPlyVertices + "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n"),
      {{"a.png", red_and_blue()}, {"b.png", png_of({1, 2, 3}, 1)}});
  EXPECT_THAT(several.texturing.pictures, SizeIs(2));
  EXPECT_THAT(several.repairs,
              ElementsAre("2 texture maps baked into vertex colours; no step is needed"));
}

TEST(PlyTexturing, PicturesWithoutCoordinatesAreNamed) {
  const auto result =
      read_carried(textured_ply(kTwoTextures, "", "", kPlyVertices + "3 0 1 2\n3 0 2 3\n"),
                   {{"a.png", red_and_blue()}, {"b.png", red_and_blue()}});
  EXPECT_TRUE(result.texturing.empty());
  EXPECT_THAT(result.repairs,
              ElementsAre("2 texture maps not carried: the file has no texture coordinates; export "
                          "them, too"));
}

TEST(PlyTexturing, SeveralTexturesNeedTexnumber) {
  const auto result =
      read_carried(textured_ply(kTwoTextures, "", "property list uchar float texcoord\n",
                                kPlyVertices + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n"),
                   {{"a.png", red_and_blue()}, {"b.png", red_and_blue()}});
  EXPECT_TRUE(result.texturing.empty());
  EXPECT_THAT(result.repairs, Contains(HasSubstr("export them with texnumber")));
}

TEST(PlyTexturing, MissingPicturesAreNamedAndTheOthersCarried) {
  const auto result = read_carried(
      textured_ply(kTwoTextures, "", "property list uchar float texcoord\nproperty int texnumber\n",
                   kPlyVertices + "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n"),
      {{"b.png", red_and_blue()}});
  EXPECT_FALSE(result.texturing.materials.at(0).base_colour_map);
  EXPECT_TRUE(result.texturing.materials.at(1).base_colour_map);
  EXPECT_THAT(result.repairs, Contains(HasSubstr("'a.png' not carried: it is not beside")));
}

}  // namespace
}  // namespace vitrine
