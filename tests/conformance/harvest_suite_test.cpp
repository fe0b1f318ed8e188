// SPDX-License-Identifier: Apache-2.0
// Tests how a catalogue lists models by their last changes, and their collections.
#include <gtest/gtest.h>

#include <chrono>
#include <tuple>

#include "conformance/catalogue_suite.h"
#include "conformance/id_of.h"

namespace vitrine::test {
namespace {

ModelRecord harvested(std::uint8_t value, const std::string& title = "A skull",
                      ModelState state = ModelState::kPublished) {
  return {.id = id_of(value), .state = state, .title = title, .repairs = "1 face dropped"};
}

class HarvestSuite : public testing::Test {
 protected:
  std::unique_ptr<CatalogueBackend> backend_ = make_catalogue_backend();
  std::unique_ptr<server::Catalogue> catalogue_ = backend_->connect();

  void add(const ModelRecord& record) {
    const auto added = catalogue_->add(record, {});
    ASSERT_TRUE(added) << added.error().message;
  }
};

std::int64_t now_in_seconds() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

TEST_F(HarvestSuite, AHarvestHasThePublishedModelsOfAPeriod) {
  const std::int64_t before = now_in_seconds();
  add(harvested(1));
  add(harvested(2, "A draft", ModelState::kDraft));
  const auto all = catalogue_->harvest({}).value();
  ASSERT_EQ(all.models.size(), 1u);
  EXPECT_EQ(all.all, 1u);
  EXPECT_EQ(all.models[0].model.id, id_of(1));
  EXPECT_EQ(all.models[0].model.repairs, harvested(1).repairs);
  const std::int64_t changed = all.models[0].changed;
  EXPECT_GE(changed, before - 1);  // the database may round to whole seconds
  EXPECT_LE(changed, now_in_seconds() + 1);
  const auto found = [&](const HarvestQuery& query) { return catalogue_->harvest(query)->all; };
  EXPECT_EQ(found({.from = changed, .until = changed}), 1u);
  EXPECT_EQ(found({.from = changed + 1}), 0u);
  EXPECT_EQ(found({.until = changed - 1}), 0u);
  EXPECT_EQ(found({.model = id_of(1)}), 1u);
  EXPECT_EQ(found({.model = id_of(2)}), 0u);
}

TEST_F(HarvestSuite, AHarvestInPagesHasEachModelOnce) {
  for (const int i : {3, 1, 5, 2, 4})
    add(harvested(static_cast<std::uint8_t>(i)));
  HarvestQuery query{.limit = 2};
  std::vector<HarvestPlace> places;
  for (Harvest page; !(page = catalogue_->harvest(query).value()).models.empty();) {
    EXPECT_EQ(page.all, places.empty() ? 5u : 0u);
    EXPECT_LE(page.models.size(), 2u);
    for (const auto& found : page.models)
      places.push_back({found.changed, found.model.id});
    query.after = places.back();
  }
  ASSERT_EQ(places.size(), 5u);
  for (std::size_t i = 1; i < places.size(); ++i) {
    EXPECT_LT(std::tie(places[i - 1].changed, places[i - 1].model),
              std::tie(places[i].changed, places[i].model));
  }
}

TEST_F(HarvestSuite, AHarvestFindsAModelAgainAfterEachChange) {
  add(harvested(1));
  const auto read = [&] { return catalogue_->harvest({}).value(); };
  const auto changed = [&] { return read().models.at(0).changed; };
  const std::int64_t added = changed();
  while (read().now == added) {  // waits until the database's clock shows another second
  }
  ASSERT_TRUE(catalogue_->update(*catalogue_->find(id_of(1)).value(), std::nullopt));
  const std::int64_t updated = changed();
  EXPECT_GT(updated, added);
  EXPECT_LE(updated, read().now);
  while (read().now == updated) {
  }
  ASSERT_TRUE(catalogue_->set_state(id_of(1), ModelState::kPublished));
  EXPECT_GT(changed(), updated);
}

TEST_F(HarvestSuite, ACursorBeforeThePeriodGivesNoModelBeforeIt) {
  add(harvested(1));
  const std::int64_t changed = catalogue_->harvest({})->models.at(0).changed;
  const auto found = [&](std::int64_t from) {
    return catalogue_->harvest({.from = from, .after = HarvestPlace{}})->models.size();
  };
  EXPECT_EQ(found(changed), 1u);
  EXPECT_EQ(found(changed + 1), 0u);
}

TEST_F(HarvestSuite, CollectionsAreThoseOfPublishedModels) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(catalogue_->collections().value(), Names());
  ModelRecord one = harvested(1), two = harvested(2),
              draft = harvested(3, "A draft", ModelState::kDraft);
  one.more["collection"] = "Vases; Égypte";
  two.more["collection"] = "Vases";
  draft.more["collection"] = "Hidden";
  for (const auto& record : {one, two, draft})
    add(record);
  EXPECT_EQ(catalogue_->collections().value(), (Names{"Vases", "Égypte"}));
  const auto in = [&](const char* collection) {
    return catalogue_->harvest({.collection = collection})->all;
  };
  EXPECT_EQ(in("Vases"), 2u);
  EXPECT_EQ(in("Égypte"), 1u);
  EXPECT_EQ(in("Hidden"), 0u);
  EXPECT_EQ(in("Vas"), 0u);
}

}  // namespace
}  // namespace vitrine::test
