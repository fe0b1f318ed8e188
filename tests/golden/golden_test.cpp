// SPDX-License-Identifier: Apache-2.0
// The committed files must decode to the committed surfaces at every level. The same input must be
// encoded to the same bytes, because the format of a released version does not change.
#include <gtest/gtest.h>

#include <filesystem>

#include "codec/base/base_decoder.h"
#include "golden/golden_models.h"
#include "support/meshes.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

const std::string kFolder = VITRINE_SOURCE_DIR "/tests/golden/";

std::vector<std::uint8_t> golden_file(const std::string& name) {
  return file_bytes(kFolder + name);
}

// This includes the files in the folder `earlier`. They are from an older encoder, which chose
// other collapses.
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
    const auto base = decode_base(
        std::span(file).subspan(manifest->base_offset, manifest->base_length), *manifest);
    ASSERT_TRUE(base) << base.error().message;
    EXPECT_EQ(level_digests(*manifest, *base, file), std::string(text.begin(), text.end()));
    ++files;
  }
  EXPECT_GT(files, golden_models().size());
}

TEST(Golden, TheSameInputIsCodedToTheSameBytes) {
  for (const GoldenModel& golden : golden_models()) {
    EXPECT_EQ(store_model(golden.mesh, golden.options).file, golden_file(golden.name + ".pmesh"))
        << golden.name;
  }
}

TEST(Golden, TheModelsCoverPlacementsColoursBoundariesRegionsAndInsertions) {
  bool pyramid = false, colours = false, loops = false, regions = false, insertions = false;
  for (const GoldenModel& golden : golden_models()) {
    const auto manifest = parse_header(golden_file(golden.name + ".pmesh"));
    ASSERT_TRUE(manifest);
    pyramid |= manifest->placement == Placement::kPyramid;
    colours |= manifest->has(Semantic::kColour);
    loops |= manifest->loops > 1;
    regions |= manifest->tree.leaves() > 1;
    insertions |=
        manifest->has_insertions && manifest->has(Semantic::kColour) && manifest->tree.leaves() > 1;
  }
  EXPECT_TRUE(pyramid && colours && loops && regions && insertions);
}

}  // namespace
}  // namespace vitrine::test
