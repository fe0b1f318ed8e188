// SPDX-License-Identifier: Apache-2.0
#include "server/export/export_cache.h"

#include <gtest/gtest.h>

#include <latch>
#include <thread>

namespace vitrine::server {
namespace {

ExportCache::File file(std::size_t bytes) {
  return std::make_shared<const ExportedFile>(ExportedFile{std::vector<std::uint8_t>(bytes), ""});
}

TEST(ExportCache, KeepsWhatFitsAndDropsTheLeastRecentlyUsed) {
  ExportCache cache(10);
  cache.insert("a", file(4));
  cache.insert("b", file(4));
  EXPECT_TRUE(cache.find("a"));
  cache.insert("c", file(4));
  EXPECT_TRUE(cache.find("a"));
  EXPECT_FALSE(cache.find("b"));
  EXPECT_TRUE(cache.find("c"));
}

TEST(ExportCache, DoesNotKeepAFileAboveItsCapacity) {
  ExportCache cache(10);
  cache.insert("small", file(1));
  cache.insert("large", file(11));
  EXPECT_TRUE(cache.find("small"));
  EXPECT_FALSE(cache.find("large"));
}

TEST(ExportCache, AnEqualKeyIsKeptOnce) {
  ExportCache cache(10);
  cache.insert("a", file(6));
  cache.insert("a", file(6));
  cache.insert("b", file(4));
  EXPECT_TRUE(cache.find("a"));
  EXPECT_TRUE(cache.find("b"));
}

TEST(ExportCache, AFileAboveItsCapacityIsSharedAsLongAsSomebodyHoldsIt) {
  ExportCache cache(10);
  const auto make = [] {
    return Expected<std::vector<std::uint8_t>>(std::vector<std::uint8_t>(11));
  };
  auto first = cache.find_or_make("large", make).value();
  EXPECT_EQ(cache.find_or_make("large", make).value(), first);
  EXPECT_EQ(cache.made, 1u);
  first.reset();
  EXPECT_FALSE(cache.find("large"));
}

TEST(ExportCache, WhatFailsIsMadeAgain) {
  ExportCache cache(10);
  const auto fails = []() -> Expected<std::vector<std::uint8_t>> {
    return fail(ErrorCode::kIo, "the disk");
  };
  EXPECT_FALSE(cache.find_or_make("a", fails));
  EXPECT_TRUE(cache.find_or_make(
      "a", [] { return Expected<std::vector<std::uint8_t>>(std::vector<std::uint8_t>(1)); }));
}

constexpr int kVisitors = 4;

// Requests the same file from kVisitors threads at the same time. `make` runs only after all of
// them have started. Returns the result of each request.
template <class Make>
std::vector<Expected<ExportCache::File>> all_at_once(ExportCache& cache, const Make& make) {
  std::latch here(kVisitors);
  std::vector<Expected<ExportCache::File>> found(kVisitors);
  std::vector<std::jthread> visitors;
  for (auto& mine : found) {
    visitors.emplace_back([&] {
      here.count_down();
      mine = cache.find_or_make("a", [&] {
        here.wait();
        return make();
      });
    });
  }
  visitors.clear();
  return found;
}

TEST(ExportCache, WhatManyAskForAtOnceIsMadeOnce) {
  ExportCache cache(10);
  const auto found = all_at_once(
      cache, [] { return Expected<std::vector<std::uint8_t>>(std::vector<std::uint8_t>(4)); });
  EXPECT_EQ(cache.made, 1u);
  EXPECT_EQ(cache.hits, 3u);
  for (const auto& file : found)
    EXPECT_EQ(file.value(), found.front().value());
}

TEST(ExportCache, AFaultAndAnExceptionReachAllWhoWait) {
  ExportCache cache(10);
  const auto found = all_at_once(cache, []() -> Expected<std::vector<std::uint8_t>> {
    return fail(ErrorCode::kIo, "the disk");
  });
  for (const auto& file : found)
    EXPECT_FALSE(file);
  const auto throws = []() -> Expected<std::vector<std::uint8_t>> { throw std::bad_alloc(); };
  EXPECT_THROW(static_cast<void>(cache.find_or_make("a", throws)), std::bad_alloc);
  EXPECT_TRUE(cache.find_or_make(
      "a", [] { return Expected<std::vector<std::uint8_t>>(std::vector<std::uint8_t>(1)); }));
}

TEST(ExportCache, ASmallerCapacityDropsWhatIsAboveIt) {
  ExportCache cache(10);
  cache.insert("a", file(4));
  cache.insert("b", file(4));
  cache.set_capacity(5);
  EXPECT_FALSE(cache.find("a"));
  EXPECT_TRUE(cache.find("b"));
  EXPECT_EQ(cache.bytes(), 4u);
}

}  // namespace
}  // namespace vitrine::server
