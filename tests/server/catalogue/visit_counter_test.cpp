// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/visit_counter.h"

#include <gtest/gtest.h>

#include <thread>

namespace vitrine::server {
namespace {

// Stores the visits that are added. add() fails while `is_away` is true.
class FakeVisits final : public VisitCatalogue {
 public:
  Expected<void> add(const VisitsOfDays& more) override {
    if (is_away) return fail(ErrorCode::kIo, "the database is away; try again");
    ++calls;
    for (const auto& [at, counts] : more)
      stored[at] += counts;
    return {};
  }
  Expected<std::vector<ModelVisits>> by_model(const DayRange&, std::uint32_t) override {
    return std::vector<ModelVisits>();
  }
  Expected<std::vector<DayVisits>> by_day(const DayRange&, std::uint32_t) override {
    return std::vector<DayVisits>();
  }

  bool is_away = false;
  int calls = 0;
  VisitsOfDays stored;
};

class VisitCounterTest : public testing::Test {
 protected:
  const ModelDay at_{ModelId::generate(), std::chrono::sys_days(std::chrono::days(20'000))};
  const VisitCounts one_{.visits = 1, .seconds = 10, .levels = 2, .complete = 0};
  FakeVisits stored_;
  VisitCounter counter_{stored_};
};

TEST_F(VisitCounterTest, WritesSumsAndEachVisitOnce) {
  counter_.count(at_, one_);
  counter_.count(at_, one_);
  EXPECT_TRUE(stored_.stored.empty());
  ASSERT_TRUE(counter_.flush());
  ASSERT_TRUE(counter_.flush());
  EXPECT_EQ(stored_.calls, 1);
  EXPECT_EQ(stored_.stored[at_], (VisitCounts{.visits = 2, .seconds = 20, .levels = 4}));
}

TEST_F(VisitCounterTest, KeepsVisitsWhileTheDatabaseIsAway) {
  stored_.is_away = true;
  counter_.count(at_, one_);
  EXPECT_FALSE(counter_.flush());
  counter_.count(at_, one_);
  EXPECT_FALSE(counter_.flushed());
  stored_.is_away = false;
  ASSERT_TRUE(counter_.flushed());
  EXPECT_EQ(stored_.stored[at_].visits, 2u);
}

TEST_F(VisitCounterTest, ThreadsLoseNoVisit) {
  constexpr unsigned kTimes = 1'000;
  const auto work = [this] {
    for (unsigned i = 0; i < kTimes; ++i)
      counter_.count(at_, one_);
  };
  std::thread first(work), second(work);
  first.join();
  second.join();
  ASSERT_TRUE(counter_.flush());
  EXPECT_EQ(stored_.stored[at_].visits, 2 * kTimes);
}

}  // namespace
}  // namespace vitrine::server
