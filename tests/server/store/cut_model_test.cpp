// SPDX-License-Identifier: Apache-2.0
// Tests that a file remains a complete model when its finer levels are removed.
#include <gtest/gtest.h>

#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/build/verify_model.h"
#include "codec/export/write_mesh.h"
#include "server/store/model_file.h"
#include "support/meshes.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Returns a model with many small regions and many levels. Some levels are on coarser lattices.
const Bytes& whole() {
  static const Bytes file = [] {
    const auto mesh = *write_mesh(torus(120, 60), MeshFormat::kPly, {.unit = "mm"});
    return build_model(mesh, {.bits = 14, .region_vertices = 400}, {}).value().file;
  }();
  return file;
}

Bytes shown_at(const Bytes& file, std::uint32_t level) {
  Refiner refiner = open_model(file).value();
  const auto read = chunks_of(refiner.manifest(), file);
  EXPECT_TRUE(refine(refiner, WantLevel{level}, read));
  return write_mesh(refiner.display_mesh(), MeshFormat::kPly, {.unit = "mm"}).value();
}

TEST(CutModel, ShowsAtEachLevelWhatTheWholeShowsThere) {
  const Manifest manifest = parse_header(whole()).value();
  const auto levels = static_cast<std::uint32_t>(manifest.levels.size());
  ASSERT_GE(levels, 4u);
  ASSERT_GT(manifest.levels[1].shift, 0u);
  ASSERT_GT(manifest.tree.leaves(), 4u);
  for (std::uint32_t last = 0; last < levels; ++last) {
    const auto cut = with_header(whole(), {.last_level = last, .unit = {}});
    ASSERT_TRUE(cut) << cut.error().message;
    const Manifest header = parse_header(*cut).value();
    const std::uint32_t kept = last > 0 && (levels - 1 - last) % 2 != 0 ? last - 1 : last;
    ASSERT_EQ(header.levels.size(), kept + 1u);
    EXPECT_EQ(header.file_bytes, cut->size());
    const auto verified = verify_model(*cut, std::nullopt, [](auto, auto) {});
    EXPECT_TRUE(verified) << last << ": " << verified.error().message;
    for (std::uint32_t level = 0; level <= kept; ++level)
      EXPECT_EQ(shown_at(*cut, level), shown_at(whole(), level)) << level << " of " << last;
  }
}

TEST(CutModel, BeyondTheFinestLevelIsTheWhole) {
  EXPECT_EQ(with_header(whole(), {.last_level = 99, .unit = {}}).value(), whole());
}

TEST(CutModel, AnotherUnitChangesNothingElse) {
  const Bytes other = with_header(whole(), {.last_level = {}, .unit = "cm"}).value();
  Manifest expected = parse_header(whole()).value(), found = parse_header(other).value();
  EXPECT_EQ(found.unit, "cm");
  EXPECT_EQ(found.chunks.back().sha256, expected.chunks.back().sha256);
  EXPECT_EQ(shown_at(other, 1), shown_at(whole(), 1));
}

TEST(CutModel, AFileThatIsCutOffIsRefused) {
  Bytes half = whole();
  half.resize(half.size() / 2);
  EXPECT_FALSE(server::with_header(half, {.last_level = 99, .unit = {}}));
  EXPECT_TRUE(with_header(half, {.last_level = 0, .unit = {}}));
}

}  // namespace
}  // namespace vitrine::test
