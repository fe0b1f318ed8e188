// SPDX-License-Identifier: Apache-2.0
#include "server/http/export_cache.h"

#include <gtest/gtest.h>

namespace vitrine {
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

}  // namespace
}  // namespace vitrine
