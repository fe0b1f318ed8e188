// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/partial_model.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

class PartialModelTest : public ::testing::Test {
 protected:
  PartialModel open() { return std::move(PartialModel::open(folder.path() / "m.part").value()); }

  std::span<const std::uint8_t> bytes(std::uint64_t offset, std::uint64_t length) const {
    return std::span(pmesh.bytes).subspan(offset, length);
  }
  Expected<void> add_head(PartialModel& model) const {
    const auto length = pmesh.manifest.head_bytes();
    return model.add({.total = static_cast<std::uint32_t>(length)}, bytes(0, length));
  }
  SliceHeader chunk(std::uint32_t offset) const {
    return {.level = 1,
            .offset = offset,
            .total = static_cast<std::uint32_t>(pmesh.manifest.chunks[0].length)};
  }
  Expected<void> add_chunk(PartialModel& model, std::uint32_t from, std::uint32_t to) const {
    return model.add(chunk(from), bytes(pmesh.manifest.chunks[0].offset + from, to - from));
  }

  TemporaryFolder folder;
  const TinyPmesh pmesh = tiny_pmesh("a base mesh", "the chunk's bytes");
};

TEST_F(PartialModelTest, BecomesTheFile) {
  PartialModel model = open();
  EXPECT_FALSE(model.manifest());
  ASSERT_TRUE(add_head(model));
  EXPECT_EQ(model.bytes(), pmesh.manifest.head_bytes());
  EXPECT_EQ(model.level(), 0u);
  ASSERT_TRUE(add_chunk(model, 0, 5));
  EXPECT_FALSE(model.holds(0));
  ASSERT_TRUE(add_chunk(model, 5, 17));
  EXPECT_TRUE(model.holds(0));
  EXPECT_EQ(model.level(), 1u);
  EXPECT_EQ(model.held_ranges().size(), 1u);
  std::ifstream file(model.path(), std::ios::binary);
  EXPECT_EQ(std::vector<std::uint8_t>(std::istreambuf_iterator<char>(file), {}), pmesh.bytes);
}

TEST_F(PartialModelTest, TakesThePicturesThatAreNotInTheHead) {
  const TinyPmesh textured = tiny_pmesh("a base mesh", "the chunk's bytes", {"small", "larger"});
  const Manifest& manifest = textured.manifest;
  const std::span all(textured.bytes);
  const auto head = static_cast<std::uint32_t>(manifest.head_bytes());
  {
    PartialModel model = open();
    auto damaged = textured.bytes;
    damaged[head - 1] ^= 1;  // damages the picture in the file's head
    EXPECT_FALSE(model.add({.total = head}, std::span(damaged).first(head)));
    ASSERT_TRUE(model.add({.total = head}, all.first(head)));
    EXPECT_TRUE(model.holds_picture(0));
    EXPECT_FALSE(model.holds_picture(1));
    EXPECT_EQ(model.bytes(), head);
    EXPECT_FALSE(model.add_picture(1, to_bytes("another")));
    ASSERT_TRUE(model.add_picture(1, to_bytes("larger")));
    EXPECT_EQ(model.bytes(), head + 6);
  }
  PartialModel model = open();
  EXPECT_TRUE(model.holds_picture(1)) << "kept for the next run";
  const ChunkInfo& chunk = manifest.chunks[0];
  ASSERT_TRUE(model.add({.level = 1, .total = static_cast<std::uint32_t>(chunk.length)},
                        all.subspan(chunk.offset, chunk.length)));
  std::ifstream file(model.path(), std::ios::binary);
  EXPECT_EQ(std::vector<std::uint8_t>(std::istreambuf_iterator<char>(file), {}), textured.bytes);
}

TEST_F(PartialModelTest, IsContinuedByTheNextRun) {
  {
    PartialModel model = open();
    ASSERT_TRUE(add_head(model));
  }
  {
    PartialModel model = open();
    ASSERT_TRUE(model.manifest());
    EXPECT_FALSE(model.holds(0)) << "a hole";
    ASSERT_TRUE(add_head(model)) << "it may come again";
    ASSERT_TRUE(add_chunk(model, 0, 17));
  }
  EXPECT_TRUE(open().holds(0));
}

TEST_F(PartialModelTest, StartsAgainIfTheFileIsNoModel) {
  std::ofstream(folder.path() / "m.part") << std::string(5000, 'x');
  PartialModel model = open();
  EXPECT_FALSE(model.manifest());
  ASSERT_TRUE(add_head(model));
  EXPECT_FALSE(model.holds(0));
}

TEST_F(PartialModelTest, ForgetsPartsThatAConnectionLeft) {
  PartialModel model = open();
  ASSERT_TRUE(add_head(model));
  ASSERT_TRUE(add_chunk(model, 0, 5));
  model.forget_parts();
  ASSERT_TRUE(add_chunk(model, 0, 17));
  EXPECT_TRUE(model.holds(0));
}

TEST_F(PartialModelTest, RefusesSlicesThatFitNoModel) {
  PartialModel model = open();
  EXPECT_FALSE(add_chunk(model, 0, 17)) << "before the head";
  EXPECT_FALSE(model.add({.total = UINT32_MAX}, bytes(0, 10))) << "a head of 4 GB";
  model.forget_parts();
  EXPECT_FALSE(model.add({.total = 10}, bytes(0, 10))) << "half a head";
  ASSERT_TRUE(add_head(model));
  EXPECT_FALSE(add_chunk(model, 1, 17)) << "a gap";
  SliceHeader other = chunk(0);
  other.level = 2;
  EXPECT_FALSE(model.add(other, bytes(0, 5)));
  other = chunk(0);
  other.region = 1;
  EXPECT_FALSE(model.add(other, bytes(0, 5)));
  other = chunk(0);
  ++other.total;
  EXPECT_FALSE(model.add(other, bytes(0, 5)));
  EXPECT_FALSE(model.add(chunk(0), bytes(0, 17))) << "other bytes";
  EXPECT_FALSE(model.holds(0));
}

}  // namespace
}  // namespace vitrine::test
