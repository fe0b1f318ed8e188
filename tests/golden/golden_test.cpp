// SPDX-License-Identifier: Apache-2.0
// Tests that the committed files decode to the committed surfaces at every level. Also tests that
// encoding the same input gives the same bytes, because the format of a released version must not
// change.
#include <gtest/gtest.h>

#include <filesystem>

#include "golden/golden_models.h"
#include "support/meshes.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

const std::string kFolder = VITRINE_SOURCE_DIR "/tests/golden/";

std::vector<std::uint8_t> golden_file(const std::string& name) {
  return file_bytes(kFolder + name);
}

// Also tests the files in the folder `earlier`. An older encoder wrote them and chose other edge
// collapses.
TEST(Golden, FilesDecodeToTheSameSurfaceAtEveryLevel) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kFolder)) {
    if (entry.path().extension() != ".pmesh") continue;
    SCOPED_TRACE(entry.path().string());
    const auto file = file_bytes(entry.path());
    const auto text = file_bytes(std::filesystem::path(entry.path()).replace_extension(".levels"));
    const auto manifest = parse_header(file);
    ASSERT_TRUE(manifest) << manifest.error().message;
    ASSERT_EQ(manifest->file_bytes, file.size());
    EXPECT_EQ(level_digests(file), std::string(text.begin(), text.end()));
    ++files;
  }
  EXPECT_GT(files, golden_models().size());
}

TEST(Golden, TheSameInputIsCodedToTheSameBytes) {
  for (const GoldenModel& golden : golden_models()) {
    EXPECT_EQ(stored(golden).file, golden_file(golden.name + ".pmesh")) << golden.name;
  }
}

TEST(Golden, TheModelsCoverPlacementsColoursBoundariesRegionsInsertionsAndTextures) {
  bool pyramid = false, colours = false, loops = false, regions = false, insertions = false;
  bool texture = false;
  for (const GoldenModel& golden : golden_models()) {
    const auto manifest = parse_header(golden_file(golden.name + ".pmesh"));
    ASSERT_TRUE(manifest);
    pyramid |= manifest->placement == Placement::kPyramid;
    colours |= manifest->has(Semantic::kColour);
    loops |= manifest->loops > 1;
    regions |= manifest->tree.leaves() > 1;
    texture |= !manifest->texture.empty() && manifest->tree.leaves() > 1;
    insertions |=
        manifest->has_insertions && manifest->has(Semantic::kColour) && manifest->tree.leaves() > 1;
  }
  EXPECT_TRUE(pyramid && colours && loops && regions && insertions && texture);
}

}  // namespace
}  // namespace vitrine::test
