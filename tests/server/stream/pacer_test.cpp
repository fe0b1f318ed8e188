// SPDX-License-Identifier: Apache-2.0
#include "server/stream/pacer.h"

#include <gtest/gtest.h>

#include <deque>

#include "server/stream/slice.h"

namespace vitrine {
namespace {

// A link with a queue of any length: what is sent comes out at `rate` and is acknowledged after
// the way there and back.
class Link {
 public:
  double rate = 100'000;  // bytes per second
  double delay = 0.02;    // seconds, there and back

  // Sends as much as the pacer lets through, for that long.
  void run(Pacer& pacer, double seconds) {
    for (const Pacer::Time end = now + Pacer::Duration(seconds); now < end;
         now += Pacer::Duration(0.001)) {
      for (; !queue_.empty() && queue_.front().at <= now; queue_.pop_front()) {
        pacer.arrived(queue_.front().bytes, now);
        arrived += queue_.front().bytes;
      }
      while (pacer.may_send(now))
        send(pacer, pacer.slice_bytes(now));
      longest = std::max(longest, static_cast<double>(pacer.in_flight()) / rate);
    }
  }

  Pacer::Time now{};
  std::uint64_t arrived = 0;
  double longest = 0;  // queue and link, seconds

 private:
  struct Packet {
    Pacer::Time at;
    std::uint64_t bytes;
  };

  void send(Pacer& pacer, std::uint64_t bytes) {
    pacer.sent(bytes, now);
    free_ = std::max(free_, now) + Pacer::Duration(static_cast<double>(bytes) / rate);
    queue_.push_back({free_ + Pacer::Duration(delay), bytes});
  }

  std::deque<Packet> queue_;
  Pacer::Time free_{};
};

TEST(Pacer, StatesAFirstGuessUntilItHasMeasured) {
  Pacer pacer;
  EXPECT_FALSE(pacer.is_measured());
  EXPECT_EQ(pacer.rate({}), Pacer::kFirstGuess);
  Link link;
  link.run(pacer, 0.15);
  EXPECT_FALSE(pacer.is_measured());
  EXPECT_EQ(pacer.rate(link.now), Pacer::kFirstGuess);
}

class PacerTest : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(PacerTest, FindsTheRateFillsTheLinkAndKeepsItsQueueShort) {
  Link link;
  std::tie(link.rate, link.delay) = GetParam();
  Pacer pacer;
  link.run(pacer, 1.5);
  EXPECT_TRUE(pacer.is_measured());
  EXPECT_NEAR(pacer.rate(link.now) / link.rate, 1, 0.15);
  link.longest = 0;
  const std::uint64_t before = link.arrived;
  link.run(pacer, 1);
  EXPECT_GE(static_cast<double>(link.arrived - before), 0.95 * link.rate);
  EXPECT_LE(link.longest, link.delay + 0.15);
}

INSTANTIATE_TEST_SUITE_P(Links, PacerTest,
                         ::testing::Values(std::pair(50'000, 0.01), std::pair(100'000, 0.001),
                                           std::pair(200'000, 0.15), std::pair(800'000, 0.02),
                                           std::pair(10'000'000, 0.05)));

TEST(Pacer, NoticesWithinASecondThatTheLinkHasBecomeSlow) {
  Link link;
  link.rate = 800'000;
  Pacer pacer;
  link.run(pacer, 1);
  link.rate = 100'000;
  link.run(pacer, 1);
  EXPECT_NEAR(pacer.rate(link.now) / link.rate, 1, 0.15);
}

TEST(Pacer, ARateThatFallsIsNotKnownYet) {
  Link link;
  link.rate = 800'000;
  Pacer pacer;
  link.run(pacer, 1);
  EXPECT_FALSE(pacer.is_falling(link.now));
  link.rate = 100'000;
  link.run(pacer, 0.3);
  EXPECT_TRUE(pacer.is_falling(link.now));
  for (int i = 0; i < 100 && pacer.is_falling(link.now); ++i)
    link.run(pacer, 0.01);
  EXPECT_NEAR(pacer.rate(link.now) / link.rate, 1, 0.15);
}

TEST(Pacer, NoticesThatNothingArrivesAnyMore) {
  Link link;
  link.rate = 800'000;
  Pacer pacer;
  link.run(pacer, 1);
  link.rate = 1;
  link.run(pacer, 2);
  EXPECT_LT(pacer.rate(link.now), 20'000);
}

TEST(Pacer, TimeWithNothingOnItsWayTellsNothing) {
  Link link;
  Pacer pacer;
  link.run(pacer, 1);
  pacer.arrived(pacer.in_flight(), link.now);
  const double before = pacer.rate(link.now);
  EXPECT_EQ(pacer.rate(link.now + Pacer::Duration(3600)), before);
}

TEST(Pacer, HoldsBackWhereNothingIsAcknowledgedButNotForEver) {
  Pacer pacer;
  Pacer::Time now{};
  while (pacer.may_send(now))
    pacer.sent(pacer.slice_bytes(now), now);
  EXPECT_LE(pacer.in_flight(), 18'000u);
  now += Pacer::kNudge;
  EXPECT_TRUE(pacer.may_send(now));
  pacer.sent(1000, now);
  EXPECT_FALSE(pacer.may_send(now));
}

TEST(Pacer, TakesNoMoreThanWasSentForArrived) {
  Pacer pacer;
  pacer.sent(1000, {});
  pacer.arrived(UINT64_MAX, {});
  EXPECT_EQ(pacer.in_flight(), 0u);
}

// The delay of a link is seen only where no queue adds to it.
TEST(Pacer, ALongTransferDoesNotLengthenItsQueue) {
  Link link;
  Pacer pacer;
  link.run(pacer, 60);
  EXPECT_GE(static_cast<double>(link.arrived), 0.95 * 60 * link.rate);
  link.longest = 0;
  link.run(pacer, 1);
  EXPECT_LE(link.longest, link.delay + 0.15);
}

}  // namespace
}  // namespace vitrine
