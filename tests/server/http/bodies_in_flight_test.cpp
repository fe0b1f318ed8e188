// SPDX-License-Identifier: Apache-2.0
#include "server/http/bodies_in_flight.h"

#include <gtest/gtest.h>

#include <vector>

namespace vitrine::server {
namespace {

constexpr std::uint64_t kSize = BodiesInFlight::kSmall;
const std::string kNetwork = "192.0.2.1", kOther = "192.0.2.2", kThird = "192.0.2.3";

Body some_text(std::uint64_t size = kSize) {
  return std::string(size, 'a');
}

Body shared(std::uint64_t size = kSize) {
  const auto owner = std::make_shared<std::vector<std::uint8_t>>(size);
  return SharedBytes{owner, *owner};
}

TEST(BodiesInFlight, AdmitsUntilTheyAreFullAndAgainOnceOneHasGone) {
  const auto bodies = std::make_shared<BodiesInFlight>(4 * kSize);
  auto first = bodies->admit(some_text(2 * kSize), kNetwork);
  const auto second = bodies->admit(shared(), kOther);
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(bodies->admit(some_text(), kThird));
  EXPECT_FALSE(bodies->admit(shared(), kThird));
  first.reset();
  EXPECT_TRUE(bodies->admit(some_text(), kThird));
}

TEST(BodiesInFlight, ANetworkThatIsBeingServedFillsAQuarterOfThem) {
  const auto bodies = std::make_shared<BodiesInFlight>(8 * kSize);
  auto first = bodies->admit(some_text(), kNetwork);
  const auto second = bodies->admit(shared(), kNetwork);
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork));
  EXPECT_TRUE(bodies->admit(some_text(4 * kSize), kOther)) << "the first body may be larger";
  first.reset();
  EXPECT_TRUE(bodies->admit(shared(), kNetwork));
}

TEST(BodiesInFlight, AFewNetworksLeaveTheLastQuarterToThoseThatTakeLittle) {
  constexpr std::uint64_t kModest = 4 * kSize, kAll = 64 * kModest;
  const auto bodies = std::make_shared<BodiesInFlight>(kAll);
  const auto large = bodies->admit(some_text(kAll / 2), kNetwork);
  const auto rest = bodies->admit(shared(kAll / 4), kOther);
  EXPECT_TRUE(large && rest);
  std::vector<std::shared_ptr<const void>> modest;
  for (int i = 0; i < 4; ++i) {
    modest.push_back(bodies->admit(some_text(), kThird));
    EXPECT_TRUE(modest.back()) << i;
  }
  EXPECT_FALSE(bodies->admit(some_text(), kThird)) << "takes more than a 64th";
  EXPECT_FALSE(bodies->admit(some_text(kModest + 1), "192.0.2.4"));
  EXPECT_TRUE(bodies->admit(some_text(kModest), "192.0.2.4"));
}

TEST(BodiesInFlight, SharedMemoryCountsForEachNetworkOnlyWhileItReceivesIt) {
  const auto bodies = std::make_shared<BodiesInFlight>(8 * kSize);
  const Body popular = shared(2 * kSize);
  auto first = bodies->admit(popular, kNetwork), again = bodies->admit(popular, kNetwork);
  const auto other = bodies->admit(popular, kOther);
  EXPECT_TRUE(first && again && other);
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork));
  EXPECT_FALSE(bodies->admit(some_text(), kOther));
  first.reset();
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork));
  again.reset();
  const auto large = bodies->admit(some_text(4 * kSize), kNetwork);
  EXPECT_TRUE(large) << "only the other network receives the shared memory";
  EXPECT_FALSE(bodies->admit(some_text(), kThird)) << "the shared memory still counts";
}

TEST(BodiesInFlight, WhatWouldFillTheLastQuarterIsNotAdmittedAlone) {
  const auto bodies = std::make_shared<BodiesInFlight>(4 * kSize);
  EXPECT_FALSE(bodies->admit(some_text(3 * kSize + 1), kNetwork));
  EXPECT_FALSE(bodies->admit(shared(3 * kSize + 1), kNetwork));
  EXPECT_FALSE(bodies->fits_alone(some_text(3 * kSize + 1)));
  EXPECT_TRUE(bodies->fits_alone(some_text(3 * kSize)));
  EXPECT_TRUE(bodies->admit(some_text(3 * kSize), kNetwork));
}

TEST(BodiesInFlight, SharedMemoryCountsOnceWhateverOfItIsSent) {
  const auto bodies = std::make_shared<BodiesInFlight>(4 * kSize);
  const Body whole = shared(3 * kSize);
  auto first = bodies->admit(whole, kNetwork);
  const auto part = bodies->admit(body_range(whole, kSize, kSize), kNetwork);
  EXPECT_TRUE(first && part);
  first.reset();
  EXPECT_FALSE(bodies->admit(some_text(), kOther)) << "a part of it is still being sent";
}

TEST(BodiesInFlight, APartOfSharedMemoryCountsAsAllOfIt) {
  const auto bodies = std::make_shared<BodiesInFlight>(4 * kSize);
  const auto part = bodies->admit(body_range(shared(3 * kSize), 0, 1), kNetwork);
  EXPECT_TRUE(part);
  EXPECT_FALSE(bodies->admit(some_text(), kOther));
}

TEST(BodiesInFlight, WhatIsSmallOrStaticIsAlwaysAdmitted) {
  static const std::vector<std::uint8_t> bytes(kSize);
  const auto bodies = std::make_shared<BodiesInFlight>(2 * kSize);
  const auto full = bodies->admit(some_text(), kNetwork);
  EXPECT_TRUE(full);
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork));
  EXPECT_TRUE(bodies->admit(some_text(kSize - 1), kNetwork));
  EXPECT_TRUE(bodies->admit(SharedBytes{nullptr, bytes}, kNetwork));
  EXPECT_TRUE(bodies->admit(StoredBytes{nullptr, 0, 10 * kSize}, kNetwork));
}

}  // namespace
}  // namespace vitrine::server
