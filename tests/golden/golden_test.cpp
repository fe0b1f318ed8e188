// SPDX-License-Identifier: Apache-2.0
// The committed files decode to the committed surfaces, level by level, and the same input is coded
// to the same bytes: the format of a released version does not change.
#include <gtest/gtest.h>

#include "codec/base/base_decoder.h"
#include "golden/golden_models.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

std::vector<std::uint8_t> golden_file(const std::string& name) {
  return file_bytes(VITRINE_SOURCE_DIR "/tests/golden/" + name);
}

TEST(Golden, FilesDecodeToTheSameSurfaceAtEveryLevel) {
  for (const GoldenModel& golden : golden_models()) {
    SCOPED_TRACE(golden.name);
    const auto file = golden_file(golden.name + ".pmesh");
    const auto text = golden_file(golden.name + ".levels");
    const auto manifest = parse_header(file);
    ASSERT_TRUE(manifest) << manifest.error().message;
    ASSERT_EQ(manifest->file_bytes, file.size());
    const auto base = decode_base(
        std::span(file).subspan(manifest->base_offset, manifest->base_length), *manifest);
    ASSERT_TRUE(base) << base.error().message;
    EXPECT_EQ(level_digests(*manifest, *base, file), std::string(text.begin(), text.end()));
  }
}

TEST(Golden, TheSameInputIsCodedToTheSameBytes) {
  for (const GoldenModel& golden : golden_models()) {
    EXPECT_EQ(store_model(golden.mesh, golden.options).file, golden_file(golden.name + ".pmesh"))
        << golden.name;
  }
}

TEST(Golden, TheModelsCoverPlacementsColoursBoundariesRegionsAndBirths) {
  bool pyramid = false, colours = false, loops = false, regions = false, births = false;
  for (const GoldenModel& golden : golden_models()) {
    const auto manifest = parse_header(golden_file(golden.name + ".pmesh"));
    ASSERT_TRUE(manifest);
    pyramid |= manifest->placement == Placement::kPyramid;
    colours |= manifest->coloured;
    loops |= manifest->loops > 1;
    regions |= manifest->tree.leaves() > 1;
    births |= manifest->births && manifest->coloured && manifest->tree.leaves() > 1;
  }
  EXPECT_TRUE(pyramid && colours && loops && regions && births);
}

}  // namespace
}  // namespace vitrine::test
