// SPDX-License-Identifier: Apache-2.0
// Tests packages as museums, archives and model sites offer them for download.
#include "codec/import/packaged_model.h"

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

const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n";
const std::string kSquareObj =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0\nvt 0.75 0\nusemtl a\n"
    "f 1/1 2/2 3/2 4/1\n";

// Returns a triangle whose buffer and picture are other files.
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
    EXPECT_THAT(read.repairs, ElementsAre("1 texture map baked into vertex colours"));
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
                              {"source/bust.fbx", "Kaydara FBX Binary  "}})),
              AllOf(HasSubstr("'source/bust.fbx' in the package: this is an FBX file: "),
                    HasSubstr("Blender")));
  EXPECT_THAT(refusal(zip_of({{"a.png", red_and_blue()}, {"b.txt", "text"}})),
              AllOf(HasSubstr("no model among its 2 files"), HasSubstr("GLB")));
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
