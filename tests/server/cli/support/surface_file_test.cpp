// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/surface_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/cli/support/companion_files.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using server::cli::CompanionFiles;
using server::cli::CompanionKinds;
using server::cli::InputFile;
using server::cli::read_surface;
using server::cli::SurfaceParts;
using testing::ElementsAre;
using testing::Key;

class SurfaceFile : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& contents) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path, std::ios::binary) << contents;
    return path;
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(SurfaceFile, TheShapeOfAGltfNeedsItsBuffersOnly) {
  const std::string path =
      write("a.gltf", R"({"buffers":[{"uri":"a.bin"}],"images":[{"uri":"a.png"}]})");
  write("a.bin", "buffer");
  write("a.png", "picture");
  const auto file = InputFile::open(path);
  EXPECT_THAT(CompanionFiles(path, file->bytes(), CompanionKinds::kBuffers).contents(),
              ElementsAre(Key("a.bin")));
  EXPECT_THAT(CompanionFiles(path, file->bytes()).contents(),
              ElementsAre(Key("a.bin"), Key("a.png")));
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
