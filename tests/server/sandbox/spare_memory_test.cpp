// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/spare_memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

namespace vitrine::server {
namespace {

class SpareMemoryTest : public ::testing::Test {
 protected:
  // Allocates blocks of `bytes` bytes until the reserve is exhausted. Returns the blocks.
  std::vector<void*> all(std::size_t bytes) {
    std::vector<void*> blocks;
    while (void* block = memory_->take(bytes))
      blocks.push_back(std::memset(block, static_cast<int>(blocks.size()), bytes));
    return blocks;
  }
  const std::unique_ptr<SpareMemory> memory_ = std::make_unique<SpareMemory>();
};

TEST_F(SpareMemoryTest, BlocksDoNotOverlapAndTheirSpaceIsReused) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{1000}, SpareMemory::kMost}) {
    const auto blocks = all(bytes);
    ASSERT_GE(blocks.size(), 16u);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::vector<std::uint8_t> wanted(bytes, static_cast<std::uint8_t>(i));
      EXPECT_EQ(std::memcmp(blocks[i], wanted.data(), bytes), 0);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks[i]) % alignof(std::max_align_t), 0u);
    }
    EXPECT_TRUE(memory_->give_back(blocks[7]));
    EXPECT_EQ(memory_->take(bytes), blocks[7]);
    for (void* block : blocks)
      EXPECT_TRUE(memory_->give_back(block));
  }
}

TEST_F(SpareMemoryTest, SeparateFreeSpacesAreNotJoined) {
  const auto blocks = all(256);
  for (const std::size_t i : {3, 5})
    EXPECT_TRUE(memory_->give_back(blocks[i]));
  EXPECT_EQ(memory_->take(512), nullptr);
  EXPECT_TRUE(memory_->give_back(blocks[4]));
  EXPECT_EQ(memory_->take(512), blocks[3]);
}

TEST_F(SpareMemoryTest, LargeOrForeignBlocksAreNotAccepted) {
  EXPECT_EQ(memory_->take(SpareMemory::kMost + 1), nullptr);
  int other = 0;
  EXPECT_FALSE(memory_->give_back(&other));
  EXPECT_FALSE(memory_->give_back(nullptr));
  EXPECT_FALSE(memory_->give_back(memory_.get() + 1));
}

}  // namespace
}  // namespace vitrine::server
