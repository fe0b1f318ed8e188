// SPDX-License-Identifier: Apache-2.0
// Tests that the time of a model's last change, by which harvesters read the catalogue, is new
// after each change. tests/conformance tests the harvest in both databases.
#include <gtest/gtest.h>

#include "server/catalogue/sqlite.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

class HarvestTimes : public testing::Test {
 protected:
  void SetUp() override {
    record_.id = ModelId::generate();
    record_.state = ModelState::kPublished;
    ASSERT_TRUE(catalogue_->add(record_, {}));
  }

  // Sets the time of the model's last change to a time in 1970, and calls `change`. Returns the new
  // time of the last change, in seconds since 1970.
  template <class Change>
  std::int64_t time_after(const Change& change) {
    sqlite::SqliteHandle(file_).run("UPDATE model_index SET changed = 7");
    EXPECT_EQ(catalogue_->harvest({})->models.at(0).changed, 7);
    EXPECT_TRUE(change());
    return catalogue_->harvest({})->models.at(0).changed;
  }

  static constexpr std::int64_t kLongAgo = 1'500'000'000;

  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "catalogue.sqlite";
  const std::unique_ptr<Catalogue> catalogue_ = open_sqlite_catalogue(file_).value();
  ModelRecord record_;
};

TEST_F(HarvestTimes, AreNewAfterAChangeOfATextThatNoIndexHas) {
  EXPECT_GT(time_after([&] {
              record_.rights = "free";
              return catalogue_->update(record_, {});
            }),
            kLongAgo);
}

TEST_F(HarvestTimes, AreNewAfterAModelWasWithdrawnAndPublishedAgain) {
  EXPECT_GT(time_after([&] {
              return catalogue_->set_state(record_.id, ModelState::kDraft) &&
                     catalogue_->set_state(record_.id, ModelState::kPublished);
            }),
            kLongAgo);
}

TEST_F(HarvestTimes, StayIfAnotherModelIsAdded) {
  ModelRecord draft;
  draft.id = ModelId::generate();
  EXPECT_EQ(time_after([&] { return catalogue_->add(draft, {}); }), 7);
}

}  // namespace
}  // namespace vitrine::server
