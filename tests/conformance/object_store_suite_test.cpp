// SPDX-License-Identifier: Apache-2.0
#include "conformance/object_store_suite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "support/held_lock.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes some_bytes(std::size_t count, std::uint8_t seed) {
  Bytes bytes(count);
  std::uint32_t state = seed;
  for (auto& byte : bytes)
    byte = static_cast<std::uint8_t>((state = state * 1664525 + 7) >> 24);
  return bytes;
}

class ObjectStoreSuite : public testing::Test {
 protected:
  std::unique_ptr<ObjectStoreBackend> backend_ = make_object_store_backend();
  std::unique_ptr<ObjectStore> store_ = backend_->connect();

  void put(const Bytes& bytes) { ASSERT_TRUE(store_->put(sha256(bytes), bytes)); }
  std::unique_ptr<Object> open(const Bytes& bytes) { return store_->open(sha256(bytes)).value(); }
};

TEST_F(ObjectStoreSuite, AnObjectIsReadBackAsItWasPut) {
  const Bytes bytes = some_bytes(100'000, 1);
  put(bytes);
  const auto object = open(bytes);
  ASSERT_TRUE(object);
  EXPECT_EQ(object->size(), bytes.size());
  EXPECT_EQ(object->read(0, bytes.size()).value(), bytes);
}

TEST_F(ObjectStoreSuite, AnyRangeCanBeRead) {
  const Bytes bytes = some_bytes(5'000, 2);
  put(bytes);
  const auto object = open(bytes);
  ASSERT_TRUE(object);
  EXPECT_EQ(object->read(1'234, 999).value(), Bytes(bytes.begin() + 1'234, bytes.begin() + 2'233));
  EXPECT_EQ(object->read(5'000, 0).value(), Bytes{});
}

TEST_F(ObjectStoreSuite, ARangeBeyondTheEndIsRefused) {
  const Bytes bytes = some_bytes(100, 3);
  put(bytes);
  const auto object = open(bytes);
  ASSERT_TRUE(object);
  EXPECT_FALSE(object->read(0, 101));
  EXPECT_FALSE(object->read(101, 0));
  EXPECT_FALSE(object->read(1, UINT64_MAX));
}

TEST_F(ObjectStoreSuite, AnEmptyObjectIsAnObject) {
  put({});
  const auto object = open({});
  ASSERT_TRUE(object);
  EXPECT_EQ(object->size(), 0u);
}

TEST_F(ObjectStoreSuite, AnAbsentObjectIsNotAnError) {
  const auto object = store_->open(sha256(some_bytes(9, 4)));
  ASSERT_TRUE(object);
  EXPECT_EQ(*object, nullptr);
}

TEST_F(ObjectStoreSuite, TheSizeIsKnownWithoutOpening) {
  const Bytes bytes = some_bytes(12'345, 4);
  EXPECT_EQ(store_->size_of(sha256(bytes)).value(), std::nullopt);
  put(bytes);
  EXPECT_EQ(store_->size_of(sha256(bytes)).value(), bytes.size());
}

TEST_F(ObjectStoreSuite, BytesUnderAWrongNameAreRefusedAndNotStored) {
  const Bytes bytes = some_bytes(10, 5), others = some_bytes(10, 6);
  const auto result = store_->put(sha256(others), bytes);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(open(others), nullptr);
  EXPECT_EQ(open(bytes), nullptr);
}

TEST_F(ObjectStoreSuite, PuttingAgainChangesNothing) {
  const Bytes bytes = some_bytes(1'000, 7);
  put(bytes);
  put(bytes);
  EXPECT_EQ(open(bytes)->read(0, 1'000).value(), bytes);
}

TEST_F(ObjectStoreSuite, ARemovedObjectIsAbsentAndCanBeRemovedAndPutAgain) {
  const Bytes bytes = some_bytes(1'000, 9), others = some_bytes(1'000, 10);
  put(bytes);
  put(others);
  EXPECT_TRUE(store_->remove(sha256(bytes)));
  EXPECT_EQ(open(bytes), nullptr);
  EXPECT_TRUE(open(others));
  EXPECT_TRUE(store_->remove(sha256(bytes)));
  put(bytes);
  EXPECT_TRUE(open(bytes));
}

TEST_F(ObjectStoreSuite, OneConnectionAtATimeHoldsTheLock) {
  std::vector<std::thread> holders;
  std::atomic<int> holding = 0;
  for (int i = 0; i < 4; ++i) {
    holders.emplace_back([this, &holding] {
      const auto connection = backend_->connect();
      for (int round = 0; round < 100; ++round) {
        const auto lock = connection->lock();
        ASSERT_TRUE(lock);
        EXPECT_EQ(++holding, 1);
        --holding;
      }
    });
  }
  for (auto& holder : holders)
    holder.join();
}

TEST_F(ObjectStoreSuite, ASweepRemovesUnnamedObjectsAfterTheirGracePeriod) {
  const Bytes named = some_bytes(1'000, 1), other = some_bytes(2'000, 2);
  put(named);
  put(other);
  const auto lock = store_->lock();
  EXPECT_EQ(store_->sweep({sha256(named)}, std::chrono::hours(1), kHeld).value(), 0u);
  EXPECT_TRUE(open(other));
  const auto reading = open(other);
  EXPECT_EQ(store_->sweep({sha256(named)}, std::chrono::seconds(0), kHeld).value(), 1u);
  EXPECT_EQ(open(other), nullptr);
  EXPECT_TRUE(open(named));
  EXPECT_EQ(reading->read(0, 2'000).value(), other);  // open readers still read the removed object
  EXPECT_EQ(store_->sweep({sha256(named)}, std::chrono::seconds(0), kHeld).value(), 0u);
}

TEST_F(ObjectStoreSuite, ASweepThatLosesTheLockRemovesNoMore) {
  const std::array all{some_bytes(1'000, 1), some_bytes(1'000, 2), some_bytes(1'000, 3)};
  for (const Bytes& bytes : all)
    put(bytes);
  const auto swept = store_->sweep({}, std::chrono::seconds(0), HeldLock(1));
  ASSERT_FALSE(swept);
  EXPECT_EQ(swept.error().code, ErrorCode::kIo);
  EXPECT_EQ(std::ranges::count_if(all, [&](const Bytes& bytes) { return open(bytes) != nullptr; }),
            2);
}

TEST_F(ObjectStoreSuite, ARestartedGracePeriodEndsLater) {
  const Bytes renewed = some_bytes(1'000, 1), other = some_bytes(1'000, 2);
  put(renewed);
  put(other);
  const auto lock = store_->lock();
  for (std::size_t swept = 0; swept == 0;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_TRUE(store_->begin_grace(sha256(renewed)));
    swept = store_->sweep({}, std::chrono::seconds(2), kHeld).value();
  }
  EXPECT_TRUE(open(renewed));
  EXPECT_EQ(open(other), nullptr);
}

TEST_F(ObjectStoreSuite, StartingTheGracePeriodOfAnAbsentObjectIsNoError) {
  const auto lock = store_->lock();
  EXPECT_TRUE(store_->begin_grace(sha256(some_bytes(9, 4))));
}

TEST_F(ObjectStoreSuite, AnotherConnectionSeesWhatWasPut) {
  const Bytes bytes = some_bytes(1'000, 8);
  put(bytes);
  const auto object = backend_->connect()->open(sha256(bytes));
  ASSERT_TRUE(object && *object);
  EXPECT_EQ((*object)->read(0, 1'000).value(), bytes);
}

TEST_F(ObjectStoreSuite, SeveralWritersOfTheSameObjectsAllSucceed) {
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 4; ++writer) {
    writers.emplace_back([this] {
      const auto connection = backend_->connect();
      for (std::uint8_t seed = 0; seed < 8; ++seed) {
        const Bytes bytes = some_bytes(20'000, seed);
        EXPECT_TRUE(connection->put(sha256(bytes), bytes));
      }
    });
  }
  for (auto& writer : writers)
    writer.join();
  for (std::uint8_t seed = 0; seed < 8; ++seed) {
    const Bytes bytes = some_bytes(20'000, seed);
    const auto object = open(bytes);
    ASSERT_TRUE(object);
    EXPECT_EQ(object->read(0, bytes.size()).value(), bytes);
  }
}

}  // namespace
}  // namespace vitrine::test
