// SPDX-License-Identifier: Apache-2.0
#include "server/stream/pacer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <ostream>
#include <queue>
#include <utility>
#include <vector>

#include "server/stream/slice.h"

namespace vitrine::server {
namespace {

// Simulates a link with an unlimited queue. The link delivers `rate` bytes per second.
// Acknowledgements arrive one round trip later.
class Link {
 public:
  double rate = 100'000;  // rate of the link, in bytes per second
  double delay = 0.02;    // round-trip time in seconds
  std::size_t busy_streams = 1;

  // Sends as much as the pacer allows for `seconds` seconds.
  void run(Pacer& pacer, double seconds) {
    for (const Pacer::Time end = now + Pacer::Duration(seconds); now < end;
         now += Pacer::Duration(0.001)) {
      for (; !queue_.empty() && queue_.front().at <= now; queue_.pop_front()) {
        pacer.arrived(queue_.front().bytes, now);
        arrived += queue_.front().bytes;
      }
      while (const std::uint32_t room = pacer.room(now, busy_streams))
        send(pacer, room);
      longest = std::max(longest, static_cast<double>(pacer.in_flight()) / rate);
    }
  }

  Pacer::Time now{};
  std::uint64_t arrived = 0;
  double longest = 0;  // longest time of a slice in the queue and on the link, in seconds

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
                                           std::pair(100'000, 0.1), std::pair(200'000, 0.15),
                                           std::pair(400'000, 0.001), std::pair(400'000, 0.1),
                                           std::pair(800'000, 0.02), std::pair(800'000, 0.1),
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
  while (const std::uint32_t room = pacer.room(now, 1))
    pacer.sent(room, now);
  EXPECT_LE(pacer.in_flight(), 18'000u);
  now += Pacer::kNudge;
  EXPECT_GT(pacer.room(now, 1), 0u);
  pacer.sent(1000, now);
  EXPECT_EQ(pacer.room(now, 1), 0u);
}

TEST(Pacer, TakesNoMoreThanWasSentForArrived) {
  Pacer pacer;
  pacer.sent(1000, {});
  pacer.arrived(UINT64_MAX, {});
  EXPECT_EQ(pacer.in_flight(), 0u);
}

// Tests that a long transfer does not lengthen the queue of the link. The pacer can measure the
// link's delay only while no queue adds to it.
TEST(Pacer, ALongTransferDoesNotLengthenItsQueue) {
  Link link;
  Pacer pacer;
  link.run(pacer, 60);
  EXPECT_GE(static_cast<double>(link.arrived), 0.95 * 60 * link.rate);
  link.longest = 0;
  link.run(pacer, 1);
  EXPECT_LE(link.longest, link.delay + 0.15);
}

struct FarCase {
  std::size_t busy_streams;
  bool is_direct;
};
void PrintTo(const FarCase& one, std::ostream* out) {
  *out << one.busy_streams << (one.is_direct ? " directly" : " behind a proxy");
}

class FarPacerTest : public ::testing::TestWithParam<FarCase> {};

// Many busy streams must not slow down a link that has a long delay and is not full.
TEST_P(FarPacerTest, FillsALongLinkInACrowd) {
  Link link;
  link.rate = 400'000, link.delay = 0.15, link.busy_streams = GetParam().busy_streams;
  Pacer pacer;
  if (GetParam().is_direct) pacer.know_delay(Pacer::Duration(link.delay));
  link.run(pacer, 3);
  const std::uint64_t before = link.arrived;
  link.run(pacer, 5);
  EXPECT_GE(static_cast<double>(link.arrived - before), 0.85 * 5 * link.rate);
}

INSTANTIATE_TEST_SUITE_P(Crowds, FarPacerTest,
                         ::testing::Values(FarCase{20, true}, FarCase{500, true},
                                           FarCase{20, false}, FarCase{100, false}));

// Simulates several connections whose slices and acknowledgements wait in one common queue, first
// come, first served.
class SharedQueue {
 public:
  SharedQueue(std::size_t size, double rate) : members_(size), rate_(rate) {
    for (Member& member : members_)
      member.pacer.know_delay(Pacer::Duration(kDelay));
  }

  // Simulates the time up to `until`. Three quarters of the connections begin in the first two
  // seconds. The others begin when the first connections have filled the queue.
  void run(double until) {
    for (; now_ < until; now_ += 0.001) {
      for (; !queue_.empty() && queue_.top().at <= now_; queue_.pop())
        arrive(queue_.top());
      for (std::size_t i = 0; i < members_.size(); ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(members_.size());
        if (now_ >= (i % 4 == 3 ? 6 + part : 2 * part)) pull(i);
      }
    }
  }

  // Returns the bytes that each connection has received since the last call, in ascending order.
  std::vector<double> shares() {
    std::vector<double> shares;
    for (Member& member : members_)
      shares.push_back(static_cast<double>(std::exchange(member.arrived, 0)));
    std::ranges::sort(shares);
    return shares;
  }

 private:
  static constexpr double kDelay = 0.001;
  struct Member {
    Pacer pacer;
    std::uint64_t arrived = 0;
  };
  struct Packet {
    double at;
    std::size_t member;
    std::uint64_t bytes;
    // The priority queue has the earliest packet on top.
    bool operator<(const Packet& other) const { return at > other.at; }
  };

  static Pacer::Time time(double now) { return Pacer::Time(Pacer::Duration(1000 + now)); }

  void arrive(const Packet& packet) {
    Member& member = members_[packet.member];
    member.pacer.arrived(packet.bytes, time(now_));
    member.arrived += packet.bytes;
    busy_ -= member.pacer.in_flight() == 0 ? 1 : 0;
    pull(packet.member);
  }

  void pull(std::size_t number) {
    constexpr std::uint64_t kCredit = 64 * 1024;
    Pacer& pacer = members_[number].pacer;
    while (const std::uint64_t bytes = std::min<std::uint64_t>(pacer.room(time(now_), busy_),
                                                               kCredit - pacer.in_flight())) {
      busy_ += pacer.in_flight() == 0 ? 1 : 0;
      pacer.sent(bytes, time(now_));
      free_ = std::max(free_, now_) + static_cast<double>(bytes) / rate_;
      queue_.push({free_ + kDelay, number, bytes});
    }
  }

  std::vector<Member> members_;
  const double rate_;
  double now_ = 0, free_ = 0;
  std::size_t busy_ = 0;
  std::priority_queue<Packet> queue_;
};

struct CrowdCase {
  std::size_t members;
  double rate;  // bytes per second, for all connections together
};
void PrintTo(const CrowdCase& one, std::ostream* out) {
  *out << one.members << " at " << one.rate;
}

class PacerCrowdTest : public ::testing::TestWithParam<CrowdCase> {};

// Checks the shares only after 20 s. This is twice the interval at which the pacer measures the
// link's delay again.
TEST_P(PacerCrowdTest, ComesToEqualShares) {
  SharedQueue queue(GetParam().members, GetParam().rate);
  queue.run(20);
  queue.shares();
  for (const double until : {25.0, 30.0}) {
    queue.run(until);
    const std::vector<double> shares = queue.shares();
    EXPECT_GE(shares.front(), shares[shares.size() / 2] / 2);
    double all = 0;
    for (const double share : shares)
      all += share;
    EXPECT_GE(all, 0.95 * 5 * GetParam().rate);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, PacerCrowdTest,
                         ::testing::Values(CrowdCase{20, 2e6}, CrowdCase{50, 5e6},
                                           CrowdCase{200, 20e6}, CrowdCase{200, 60e6}));

}  // namespace
}  // namespace vitrine::server
