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
  const auto bodies = std::make_shared<BodiesInFlight>(2 * kSize);
  auto first = bodies->admit(some_text(), kNetwork);
  const auto second = bodies->admit(shared(), kOther);
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(bodies->admit(some_text(), kThird));
  EXPECT_FALSE(bodies->admit(shared(), kThird));
  first.reset();
  EXPECT_TRUE(bodies->admit(some_text(), kThird));
}

TEST(BodiesInFlight, ANetworkThatIsBeingServedFillsHalfOfThem) {
  const auto bodies = std::make_shared<BodiesInFlight>(4 * kSize);
  auto first = bodies->admit(some_text(), kNetwork);
  const auto second = bodies->admit(shared(), kNetwork);
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork));
  EXPECT_TRUE(bodies->admit(some_text(2 * kSize), kOther));
  first.reset();
  EXPECT_TRUE(bodies->admit(shared(), kNetwork));
}

TEST(BodiesInFlight, OneBodyOfANetworkMayFillThem) {
  const auto bodies = std::make_shared<BodiesInFlight>(4 * kSize);
  EXPECT_TRUE(bodies->admit(some_text(4 * kSize), kNetwork));
  EXPECT_TRUE(bodies->admit(shared(4 * kSize), kNetwork)) << "the first body has gone";
}

TEST(BodiesInFlight, WhatIsLargerThanAllOfItIsNotAdmittedAlone) {
  const auto bodies = std::make_shared<BodiesInFlight>(kSize);
  EXPECT_FALSE(bodies->admit(some_text(kSize + 1), kNetwork));
  EXPECT_FALSE(bodies->admit(shared(kSize + 1), kNetwork));
  EXPECT_FALSE(bodies->fits_alone(some_text(kSize + 1)));
  EXPECT_TRUE(bodies->fits_alone(some_text()));
  EXPECT_TRUE(bodies->admit(some_text(), kNetwork));
}

TEST(BodiesInFlight, SharedMemoryCountsOnceWhateverOfItIsSent) {
  const auto bodies = std::make_shared<BodiesInFlight>(3 * kSize);
  const Body whole = shared(3 * kSize);
  auto first = bodies->admit(whole, kNetwork);
  const auto part = bodies->admit(body_range(whole, kSize, kSize), kNetwork);
  EXPECT_TRUE(first && part);
  first.reset();
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork)) << "a part of it is still being sent";
}

TEST(BodiesInFlight, WhatIsSmallOrStaticIsAlwaysAdmitted) {
  static const std::vector<std::uint8_t> bytes(kSize);
  const auto bodies = std::make_shared<BodiesInFlight>(kSize);
  const auto full = bodies->admit(some_text(), kNetwork);
  EXPECT_FALSE(bodies->admit(some_text(), kNetwork));
  EXPECT_TRUE(bodies->admit(some_text(kSize - 1), kNetwork));
  EXPECT_TRUE(bodies->admit(SharedBytes{nullptr, bytes}, kNetwork));
  EXPECT_TRUE(bodies->admit(StoredBytes{nullptr, 0, 10 * kSize}, kNetwork));
}

}  // namespace
}  // namespace vitrine::server
