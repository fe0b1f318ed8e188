// SPDX-License-Identifier: Apache-2.0
// Tests that a catalogue adds up the visits for each model and day.
#include <gtest/gtest.h>

#include <thread>

#include "conformance/catalogue_suite.h"
#include "conformance/id_of.h"

namespace vitrine::test {
namespace {

using std::chrono::days;
using std::chrono::sys_days;

const sys_days kDay{days(20'000)};

class VisitsSuite : public testing::Test {
 protected:
  VisitsSuite() {
    EXPECT_TRUE(catalogue_->add({.id = id_of(1), .title = "Model 1"}, {}));
    EXPECT_TRUE(catalogue_->add({.id = id_of(2), .title = "Model 2"}, {}));
  }

  static ModelDay at(std::uint8_t model, int day = 0) { return {id_of(model), kDay + days(day)}; }
  // Returns the model's sums over the days from kDay to kDay + `last`.
  VisitCounts counts_of(std::uint8_t model, int last = 0) {
    const std::vector<ModelVisits> all = visits_->by_model({kDay, kDay + days(last)}, 10).value();
    for (const ModelVisits& one : all) {
      if (one.model == ModelId(id_of(model))) return one.counts;
    }
    return {};
  }

  const std::unique_ptr<CatalogueBackend> backend_ = make_catalogue_backend();
  const std::unique_ptr<Catalogue> catalogue_ = backend_->connect();
  const std::unique_ptr<VisitCatalogue> visits_ = backend_->connect_visits();
  const VisitCounts one_{.visits = 1, .seconds = 60, .levels = 3, .complete = 1};
};

TEST_F(VisitsSuite, CountsOfADayAreAdded) {
  ASSERT_TRUE(visits_->add({{at(1), one_}}));
  ASSERT_TRUE(backend_->connect_visits()->add({{at(1), one_}, {at(2), {.seconds = 5}}}));
  EXPECT_EQ(counts_of(1), (VisitCounts{.visits = 2, .seconds = 120, .levels = 6, .complete = 2}));
  EXPECT_EQ(counts_of(2), (VisitCounts{.seconds = 5}));
}

TEST_F(VisitsSuite, SumsAreLargerThan32Bits) {
  const std::uint64_t large = std::uint64_t{1} << 40;
  ASSERT_TRUE(visits_->add({{at(1), {.seconds = large}}, {at(1, 1), {.seconds = large}}}));
  EXPECT_EQ(counts_of(1, 1).seconds, 2 * large);
}

TEST_F(VisitsSuite, ARangeHasItsFirstAndItsLastDay) {
  for (int day = -1; day <= 2; ++day)
    ASSERT_TRUE(visits_->add({{at(1, day), one_}}));
  EXPECT_EQ(counts_of(1, 1).visits, 2u);
}

TEST_F(VisitsSuite, TheMostVisitedModelIsTheFirst) {
  ASSERT_TRUE(visits_->add({{at(1), one_}, {at(2), one_}, {at(2, 1), one_}}));
  const auto all = visits_->by_model({kDay, kDay + days(1)}, 10).value();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].title, "Model 2");
  EXPECT_EQ(all[1].title, "Model 1");
  EXPECT_EQ(visits_->by_model({kDay, kDay + days(1)}, 1).value().size(), 1u);
}

TEST_F(VisitsSuite, DaysAreListedInOrder) {
  ASSERT_TRUE(visits_->add({{at(1, 1), one_}, {at(2), one_}, {at(1), one_}}));
  const auto all = visits_->by_day({kDay, kDay + days(1)}, 10).value();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].day, kDay);
  EXPECT_EQ(all[0].of.model, ModelId(id_of(1)));
  EXPECT_EQ(all[1].of.title, "Model 2");
  EXPECT_EQ(all[1].of.counts, one_);
  EXPECT_EQ(all[2].day, kDay + days(1));
  EXPECT_EQ(visits_->by_day({kDay, kDay + days(1)}, 2).value().size(), 2u);
}

TEST_F(VisitsSuite, AModelThatDoesNotExistIsIgnored) {
  ASSERT_TRUE(visits_->add({{at(1), one_}, {at(9), one_}}));
  EXPECT_EQ(visits_->by_day({kDay, kDay}, 10).value().size(), 1u);
}

TEST_F(VisitsSuite, ARemovedModelTakesItsVisitsWithIt) {
  ASSERT_TRUE(visits_->add({{at(1), one_}, {at(2), one_}}));
  ASSERT_TRUE(catalogue_->remove(id_of(1), {}));
  ASSERT_TRUE(catalogue_->add({.id = id_of(1)}, {}));
  EXPECT_EQ(counts_of(1), VisitCounts());
  EXPECT_EQ(counts_of(2), one_);
}

TEST_F(VisitsSuite, VisitsDoNotMakeCachedModelsStale) {
  const auto before = catalogue_->revision().value();
  ASSERT_TRUE(visits_->add({{at(1), one_}}));
  EXPECT_EQ(catalogue_->revision().value(), before);
}

TEST_F(VisitsSuite, DaemonsThatAddAtTheSameTimeLoseNoVisit) {
  constexpr unsigned kTimes = 20;
  const auto work = [this] {
    const auto visits = backend_->connect_visits();
    for (unsigned i = 0; i < kTimes; ++i)
      EXPECT_TRUE(visits->add({{at(1), one_}, {at(2), one_}}));
  };
  std::thread first(work), second(work);
  first.join();
  second.join();
  EXPECT_EQ(counts_of(1).visits, 2 * kTimes);
  EXPECT_EQ(counts_of(2).visits, 2 * kTimes);
}

}  // namespace
}  // namespace vitrine::test
