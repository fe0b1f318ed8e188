// SPDX-License-Identifier: Apache-2.0
// Tests packages of the kinds that museums, archives and model sites offer for download.
#include "codec/import/packaged_model.h"

#include <array>

#include "codec/import/dae_builder.h"
#include "codec/import/fbx_builder.h"
#include "codec/import/glb_builder.h"
#include "codec/import/reading.h"
#include "codec/picture/pictures.h"
#include "support/packages/write_package.h"

namespace vitrine {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using vitrine::test::FilesToPack;
using vitrine::test::gzip_of;
using vitrine::test::package_of;
using vitrine::test::tar_of;
using vitrine::test::zip_of;
using vitrine::testing::as_bytes;
using vitrine::testing::as_text;
using vitrine::testing::GlbBuilder;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::png_of;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;
using vitrine::testing::textured_dae;
using vitrine::testing::textured_fbx;

const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n";
const std::string kSquareObj =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0\nvt 0.75 0\nusemtl a\n"
    "f 1/1 2/2 3/2 4/1\n";

// Returns the files of a glTF triangle. Its buffer and its picture are separate files.
FilesToPack gltf_files() {
  GlbBuilder builder;
  const std::size_t points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  const std::size_t places = builder.floats("VEC2", {0.25, 0, 0.75, 0, 0.25, 0}, 3);
  builder.append("images", {{"uri", "textures/statue_baseColor.png"}});
  builder.append("textures", {{"source", 0}});
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", places}}}, {"material", 0}});
  return {{"scene.gltf", builder.text_file("scene.bin")},
          {"scene.bin", builder.binary()},
          {"textures/statue_baseColor.png", red_and_blue()},
          {"license.txt", "Model Information:\n* title: Statue\n"}};
}

// Returns the files with their paths prefixed by `folder`, which must end with a slash.
FilesToPack below(const std::string& folder, FilesToPack files) {
  for (auto& [path, contents] : files)
    path = folder + path;
  return files;
}

FilesToPack obj_files(const std::string& stem, const std::string& picture = red_and_blue()) {
  return {{stem + ".obj", kSquareObj},
          {"a.mtl", "newmtl a\nmap_Kd " + stem + ".png\n"},
          {stem + ".png", picture}};
}

FilesToPack operator+(FilesToPack files, const FilesToPack& more) {
  files.insert(files.end(), more.begin(), more.end());
  return files;
}

TEST(Packages, AGltfWithItsBufferAndPictures) {
  for (const std::string& package :
       {zip_of(gltf_files()), package_of(gltf_files(), "zip", "zip:compression=store"),
        tar_of(gltf_files()), gzip_of(tar_of(gltf_files())),
        zip_of(below("statue-of-a-man/", gltf_files()))}) {
    const ImportedMesh read = read_text(package);
    EXPECT_THAT(read.mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
    EXPECT_THAT(read.repairs,
                ElementsAre("1 texture map baked into vertex colours; no step is needed"));
    EXPECT_EQ(read.unit, "m");
    EXPECT_EQ(stated_unit(as_bytes(package)), "m");
  }
}

TEST(Packages, AnObjWithItsLibraryAndPictureInFolders) {
  const ImportedMesh read = read_text(
      zip_of(below("OBJ/", obj_files("temple")) +
             FilesToPack{{"Metadata/report.pdf", "%PDF-1.7"}, {"README.md", "# Temple"}}));
  EXPECT_EQ(read.mesh.attributes.colours, (std::vector<Colour>{kRed, kBlue, kBlue, kRed}));
}

TEST(Packages, PicturesInAnotherFolderAreFound) {
  const ImportedMesh read =
      read_text(zip_of({{"source/b\xC3\xBCste.obj", kSquareObj},
                        {"source/a.mtl", "newmtl a\nmap_Kd C:\\b\xC3\xBC.png\n"},
                        {"textures/b\xC3\xBC.png", red_and_blue()}}));
  EXPECT_EQ(read.mesh.attributes.colours.at(0), kRed);
}

TEST(Packages, APackageInAPackage) {
  const ImportedMesh read =
      read_text(zip_of({{"source/bust.zip",
                         zip_of({{"bust.obj", kSquareObj}, {"a.mtl", "newmtl a\nmap_Kd t.png\n"}})},
                        {"textures/t.png", red_and_blue()}}));
  EXPECT_EQ(read.mesh.attributes.colours.at(0), kRed);
}

TEST(Packages, OfPicturesWithTheSameNameTheNearestOneCounts) {
  const std::string library = "newmtl a\nmap_Kd t.png\n";
  const ImportedMesh read = read_text(zip_of({{"0/t.png", png_of({1, 1, 1}, 1)},
                                              {"t.png", png_of({2, 2, 2}, 1)},
                                              {"b/maps/t.png", red_and_blue()},
                                              {"b/bust.obj", kSquareObj},
                                              {"b/a.mtl", library}}));
  EXPECT_EQ(read.mesh.attributes.colours.at(0), kRed);
}

// Returns the files of a mesh of two triangles. The first has a material from the folder `body`,
// the second from the folder `head`. Both folders have a picture named diffuse.png.
FilesToPack body_and_head(const std::string& body_map, const std::string& head_map) {
  return {{"bust.obj",
           "mtllib body/m.mtl\nmtllib head/m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 3 0 0\n"
           "v 3 1 0\nvt 0 0\nusemtl body\nf 1/1 2/1 3/1\nusemtl head\nf 4/1 5/1 6/1\n"},
          {"body/m.mtl", "newmtl body\nmap_Kd " + body_map + "\n"},
          {"head/m.mtl", "newmtl head\nmap_Kd " + head_map + "\n"},
          {"body/diffuse.png", png_of({255, 0, 0}, 1)},
          {"head/diffuse.png", png_of({0, 0, 255}, 1)}};
}

TEST(Packages, PicturesWithTheSameNameInTwoFoldersStayApart) {
  for (const auto& [body, head] : std::vector<std::pair<std::string, std::string>>{
           {"diffuse.png", "diffuse.png"},
           {"body/diffuse.png", "head/diffuse.png"},
           {"C:\\Scan\\Body\\diffuse.png", "..\\head\\diffuse.png"}}) {
    const ImportedMesh read = read_text(zip_of(below("scan/", body_and_head(body, head))));
    EXPECT_EQ(read.mesh.attributes.colours,
              (std::vector<Colour>{kRed, kRed, kRed, kBlue, kBlue, kBlue}))
        << body;
  }
}

TEST(Packages, CopiesOfAPictureAreNotAmbiguous) {
  const ImportedMesh read = read_text(zip_of({{"bust.obj", kSquareObj},
                                              {"a.mtl", "newmtl a\nmap_Kd diffuse.png\n"},
                                              {"maps/diffuse.png", red_and_blue()},
                                              {"web/diffuse.png", red_and_blue()}}));
  EXPECT_EQ(read.mesh.attributes.colours.at(0), kRed);
}

TEST(Packages, AnAmbiguousPictureIsNamed) {
  const ImportedMesh read = read_text(zip_of({{"bust.obj", kSquareObj},
                                              {"a.mtl", "newmtl a\nmap_Kd diffuse.png\n"},
                                              {"body/diffuse.png", png_of({1, 1, 1}, 1)},
                                              {"head/diffuse.png", red_and_blue()}}));
  EXPECT_THAT(read.repairs, Contains(HasSubstr("such as 'body/diffuse.png' and 'head/diffuse.png'; "
                                               "state the path")));
}

TEST(Packages, PicturesOfOtherFormatsAreNamed) {
  const std::string brand("\0\0\0\x18", 4);
  for (const auto& [name, contents, type] :
       std::vector<std::array<std::string, 3>>{{"t.HEIC", brand + "ftypheic", "image/heic"},
                                               {"t.heif", brand + "ftypmif1", "image/heic"},
                                               {"t.avif", brand + "ftypavif", "image/avif"},
                                               {"t.jp2", brand + "jP  ", "image/jp2"},
                                               {"t.j2k", "\xFF\x4F\xFF\x51", "image/jp2"},
                                               {"t.jxl", "\xFF\x0A", "image/jxl"},
                                               {"t.hdr", "#?RADIANCE\n", "image/vnd.radiance"},
                                               {"t.exr", "\x76\x2F\x31\x01", "image/x-exr"},
                                               {"t.ktx", "\xABKTX 11", "image/ktx"},
                                               {"t.psd", "8BPS", "image/vnd.adobe.photoshop"},
                                               {"t.gif", "GIF89a", "image/gif"}}) {
    const ImportedMesh read = read_text(zip_of({{"bust.obj", kSquareObj},
                                                {"a.mtl", "newmtl a\nmap_Kd " + name + "\n"},
                                                {"maps/" + name, contents}}));
    EXPECT_THAT(read.repairs, Contains(HasSubstr("'" + name + "' not carried: it is " + type +
                                                 "; convert it to PNG, JPEG or WebP")));
  }
}

TEST(Packages, TheBufferOfAGltfMayHaveAnyName) {
  std::vector<float> points;
  for (int i = 0; i < 600; ++i) {
    for (const int part : {i, i * i % 7, i % 5})
      points.push_back(static_cast<float>(part));
  }
  for (const std::string name : {"geometry.data", "geometry.glbin", "data/geometry"}) {
    GlbBuilder builder;
    const std::size_t view =
        builder.view({reinterpret_cast<const char*>(points.data()), sizeof(float) * points.size()});
    const std::size_t positions = builder.accessor("VEC3", 5126, 600, {{"bufferView", view}});
    builder.mesh({{"attributes", {{"POSITION", positions}}}});
    ASSERT_GT(builder.binary().size(), kHeadBytes);
    const FilesToPack files{{"large.data", std::string(9'000, 'x')},
                            {"scene/scene.gltf", builder.text_file(name)},
                            {"scene/" + name, builder.binary()}};
    EXPECT_THAT(read_text(zip_of(files)).mesh.faces, SizeIs(200)) << name;
    EXPECT_THAT(refusal(zip_of({files[1]})), HasSubstr("which is not beside the mesh file"))
        << name;
  }
}

TEST(Packages, OneCompressedFile) {
  EXPECT_THAT(read_text(gzip_of(kOff)).mesh.faces, SizeIs(1));
  EXPECT_THAT(read_text(zip_of({{"a.off", kOff}})).mesh.faces, SizeIs(1));
  EXPECT_THAT(read_text(zip_of({{"a.OFF.gz", gzip_of(kOff)}})).mesh.faces, SizeIs(1));
  EXPECT_EQ(refusal(gzip_of("%PDF-1.7")),
            "this is a PDF document: export the model itself, as GLB");
  EXPECT_THAT(refusal(gzip_of("")), HasSubstr("the file is empty"));
}

TEST(Packages, FilesOfMacOsAreIgnored) {
  EXPECT_THAT(read_text(zip_of({{"bust.off", kOff},
                                {"__MACOSX/bust.off", "x"},
                                {"._bust.off", "x"},
                                {".DS_Store", "x"}}))
                  .repairs,
              ElementsAre());
}

TEST(Packages, SeveralModelsAreRefusedByName) {
  EXPECT_EQ(refusal(zip_of({{"head.stl", kStl}, {"b/foot.stl", kStl}})),
            "the package has 2 models, 'head.stl', 'b/foot.stl'; give one package or file for each "
            "of them");
  EXPECT_THAT(refusal(zip_of({{"a/model.obj", kSquareObj}, {"b/model.obj", kSquareObj}})),
              HasSubstr("2 models"));
  FilesToPack tiles;
  for (int i = 0; i < 9; ++i)
    tiles.emplace_back("tile" + std::to_string(i) + ".off", kOff);
  EXPECT_THAT(refusal(tar_of(tiles)), AllOf(HasSubstr("9 models"), HasSubstr("'tile3.off', ...")));
}

TEST(Packages, OfOneModelInSeveralFormatsTheFullestIsRead) {
  const ImportedMesh read = read_text(zip_of(
      FilesToPack{{"stl/bust.stl", kStl}, {"bust.off", kOff}} + below("obj/", obj_files("Bust"))));
  EXPECT_EQ(read.mesh.attributes.colours.at(0), kRed);
  EXPECT_THAT(read.repairs, Contains("read 'obj/Bust.obj' of the 3 files of the model in the "
                                     "package; to publish another one, give it alone"));
}

TEST(Packages, FilesOfModellingProgramsBesideTheModelAreNotRead) {
  for (const std::string name : {"bust.fbx", "rig/bust_rigged.FBX", "source/original.dae"}) {
    const ImportedMesh read =
        read_text(zip_of(obj_files("bust") + FilesToPack{{name, "no model"}}));
    EXPECT_EQ(read.mesh.attributes.colours.at(0), kRed) << name;
    EXPECT_THAT(read.repairs, Contains(HasSubstr("read 'bust.obj' of the 2 files of the model")));
  }
  EXPECT_THAT(refusal(zip_of({{"a.fbx", "x"}, {"b.dae", "x"}})), HasSubstr("2 models, 'a.fbx'"));
}

TEST(Packages, OfSeveralLevelsOfDetailTheFinestIsRead) {
  const std::string fine = kSquareObj + "f 1/1 2/2 3/2\n";
  for (const auto& [finest, coarser] :
       std::vector<std::pair<std::string, std::string>>{{"bust_lod0.obj", "bust_lod1.obj"},
                                                        {"LOD-0/a.obj", "LOD-1/a.obj"},
                                                        {"bust.obj", "bust.LOD2.obj"},
                                                        {"lod9/a.obj", "lod10/a.obj"}}) {
    const ImportedMesh read = read_text(zip_of({{coarser, kSquareObj}, {finest, fine}}));
    EXPECT_THAT(read.mesh.faces, SizeIs(3)) << finest;
    EXPECT_THAT(read.repairs, Contains(HasSubstr("read '" + finest + "' of the 2 files")));
  }
}

TEST(Packages, AModelOfAnotherFormatIsNamed) {
  EXPECT_THAT(refusal(zip_of({{"textures/a.png", red_and_blue()},
                              {"info.xml", "<?xml version=\"1.0\"?>"},
                              {"source/bust.blend", "BLENDER-v300"}})),
              AllOf(HasSubstr("'source/bust.blend' in the package: this is a Blender file: "),
                    HasSubstr("Blender")));
  EXPECT_THAT(refusal(zip_of({{"a.png", red_and_blue()}, {"b.txt", "text"}})),
              AllOf(HasSubstr("no model among its 2 files"), HasSubstr("GLB")));
}

TEST(Packages, SceneFilesGetTheirPictures) {
  for (const auto& [name, file] : {std::pair("source/bust.fbx", textured_fbx("x/A.png").file()),
                                   std::pair("bust.dae", textured_dae("A.png").text())}) {
    const ImportedMesh read = read_text(zip_of({{name, file}, {"textures/a.png", red_and_blue()}}));
    EXPECT_THAT(read.texturing.pictures, SizeIs(1)) << name;
  }
}

TEST(Packages, AFaultOfTheModelNamesItsFile) {
  EXPECT_THAT(refusal(zip_of({{"a/bust.ply", "ply\nformat ascii 1.0\n"}})),
              ::testing::StartsWith("'a/bust.ply' in the package: "));
  EXPECT_THAT(refusal(tar_of({gltf_files()[0]})), HasSubstr("'scene.bin', which is not beside"));
}

TEST(Packages, CutAndFlippedAtEveryByte) {
  const std::string package = zip_of(gltf_files());
  const auto expect_harmless = [](const std::string& bytes) {
    const auto read = read_mesh(as_bytes(bytes), {.limits = {.pixels = 1 << 16}});
    const std::string fault = read ? "" : read.error().message;
    EXPECT_THAT(fault, Not(HasSubstr("\n")));
  };
  for (std::size_t i = 0; i < package.size(); ++i) {
    expect_harmless(package.substr(0, i));
    std::string flipped = package;
    flipped[i] = static_cast<char>(~flipped[i]);
    expect_harmless(flipped);
  }
}

}  // namespace
}  // namespace vitrine
