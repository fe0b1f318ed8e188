// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/surface_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "codec/import/fbx_builder.h"
#include "server/cli/support/companion_files.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using server::cli::CompanionFiles;
using server::cli::CompanionKinds;
using server::cli::InputFile;
using server::cli::read_surface;
using server::cli::SurfaceParts;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Key;
using vitrine::testing::textured_fbx;

class SurfaceFile : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& contents) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path, std::ios::binary) << contents;
    return path;
  }

  // Returns the keys of the companion files (such as pictures) that the command line finds beside a
  // mesh file.
  static std::vector<std::string> found_beside(const std::string& path) {
    const auto file = InputFile::open(path);
    std::vector<std::string> keys;
    for (const auto& [key, bytes] : CompanionFiles(path, file->bytes()).contents())
      keys.push_back(key);
    return keys;
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(SurfaceFile, TheShapeOfAGltfNeedsItsBuffersOnly) {
  const std::string path =
      write("a.gltf", R"({"asset":{},"buffers":[{"uri":"a.bin"}],"images":[{"uri":"a.png"}]})");
  write("a.bin", "buffer");
  write("a.png", "picture");
  const auto file = InputFile::open(path);
  EXPECT_THAT(CompanionFiles(path, file->bytes(), CompanionKinds::kBuffers).contents(),
              ElementsAre(Key("a.bin")));
  EXPECT_THAT(CompanionFiles(path, file->bytes()).contents(),
              ElementsAre(Key("a.bin"), Key("a.png")));
}

TEST_F(SurfaceFile, TheBuffersOfAGltfMayHaveAnyName) {
  const std::string path = write(
      "a.gltf",
      "\xEF\xBB\xBF"
      R"({"asset":{},"buffers":[{"uri":"Shape.data"},{"uri":"maps\/a%20b"}],"images":[{"uri":"a.heic"}]})");
  for (const char* name : {"shape.data", "a.heic", "other.data", "a", "b"})
    write(name, "contents");
  std::filesystem::create_directory(std::filesystem::path(path).parent_path() / "maps");
  write("maps/a b", "contents");
  const auto file = InputFile::open(path);
  EXPECT_THAT(CompanionFiles(path, file->bytes(), CompanionKinds::kBuffers).contents(),
              ElementsAre(Key("a b/maps"), Key("shape.data")));
  EXPECT_THAT(CompanionFiles(path, file->bytes()).contents(),
              ElementsAre(Key("a b/maps"), Key("a.heic"), Key("shape.data")));
}

TEST_F(SurfaceFile, OtherStringsAndHiddenFilesOfAGltfAreNotOpened) {
  const std::string path = write(
      "a.gltf",
      R"({"asset":{"copyright":"a.key"},"buffers":[{"name":"b.key","uri" : "a.bin"},{"uri":".ssh/id"},{"uri":".c"}]})");
  std::filesystem::create_directory(std::filesystem::path(path).parent_path() / ".ssh");
  for (const char* name : {"a.key", "b.key", "a.bin", ".ssh/id", ".c"})
    write(name, "contents");
  EXPECT_THAT(found_beside(path), ElementsAre("a.bin"));
}

TEST_F(SurfaceFile, FilesOfOneNameInTwoFoldersAreBothOpened) {
  const std::string path = write("a.obj", "mtllib body/m.mtl\nmtllib head/m.mtl\nv 0 0 0\n");
  for (const char* folder : {"body", "head", "other"}) {
    std::filesystem::create_directory(std::filesystem::path(path).parent_path() / folder);
    write(folder + std::string("/m.mtl"), "newmtl m\nmap_Kd t.jxl\n");
    write(folder + std::string("/t.jxl"), "contents");
  }
  const auto file = InputFile::open(path);
  const Companions found = CompanionFiles(path, file->bytes()).contents();
  for (const char* key : {"m.mtl/body", "m.mtl/head", "t.jxl/body", "t.jxl/head"})
    EXPECT_THAT(found, Contains(Key(key)));
}

TEST_F(SurfaceFile, PicturesOfAnFbxAreFoundInAnyEncoding) {
  for (const std::string name :
       {"b\xC3\xA4ume.png", "b\xE4ume.png", "C:\\maps\\B\xC3\xA4ume.PNG"}) {
    const std::string path = write("a.fbx", textured_fbx(name).file());
    write("b\xC3\xA4ume.png", "contents");
    write("m.png", "not stated");
    EXPECT_THAT(found_beside(path), ElementsAre("b\xC3\xA4ume.png")) << name;
  }
}

TEST_F(SurfaceFile, PicturesOfATextFbxAreFound) {
  const std::string path =
      write("a.fbx",
            "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n}\nObjects:  {\n"
            "RelativeFilename: \"..\\A b.png\"\nOther: \"c.png\"\n}\n");
  write("a b.png", "contents");
  write("c.png", "contents");
  EXPECT_THAT(found_beside(path), ElementsAre("a b.png"));
}

TEST_F(SurfaceFile, PicturesOfADaeWithAByteOrderMarkAndEntitiesAreFound) {
  const std::string path =
      write("a.dae",
            "\xEF\xBB\xBF<?xml version=\"1.0\"?><COLLADA><library_images><image><init_from>"
            "a%20&amp;&apos;b.png</init_from></image></library_images></COLLADA>");
  write("a &'b.png", "contents");
  EXPECT_THAT(found_beside(path), ElementsAre("a &'b.png"));
}

TEST_F(SurfaceFile, PicturesNamedAsInAUriAreFound) {
  write("a.mtl", "newmtl m\nmap_Kd B%20%C3%A4.PNG\n");
  write("b \xC3\xA4.png", "contents");
  write("c%20d.png", "contents");
  const std::string obj = write("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\n");
  EXPECT_THAT(found_beside(obj), ElementsAre("a.mtl", "b \xC3\xA4.png"));
  const std::string fbx = write("a.fbx", textured_fbx("C:\\maps\\b%20%C3%A4.png").file());
  EXPECT_THAT(found_beside(fbx), ElementsAre("b \xC3\xA4.png"));
  const std::string ply = write("a.ply", "ply\ncomment TextureFile c%20d.png\n");
  EXPECT_THAT(found_beside(ply), ElementsAre("c%20d.png"));
}

TEST_F(SurfaceFile, TheShapeHasNoTexturing) {
  const std::string path = write("a.obj",
                                 "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                 "f 1 2 3\n");
  write("a.mtl", "newmtl m\nd 0.5\nmap_Ks lost.png\n");
  const auto file = InputFile::open(path);
  const CompanionFiles beside(path, file->bytes());
  const ReadOptions reading{.beside = beside.contents()};
  const auto shape = read_surface(*file, path, reading);
  const auto looks = read_surface(*file, path, reading, SurfaceParts::kLooks);
  EXPECT_TRUE(shape->texturing.empty());
  EXPECT_TRUE(shape->not_carried.empty());
  EXPECT_FALSE(looks->texturing.empty());
  EXPECT_EQ(looks->not_carried.size(), 1U);
}

}  // namespace
}  // namespace vitrine::test
