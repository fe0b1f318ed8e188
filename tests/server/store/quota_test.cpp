// SPDX-License-Identifier: Apache-2.0
#include "server/store/quota.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/change.h"
#include "server/store/file_store.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using testing::HasSubstr;

class QuotaTest : public testing::Test {
 protected:
  std::unique_ptr<Quota> quota_of(std::uint64_t bytes) {
    return std::make_unique<Quota>(*catalogue_, uploads_, bytes);
  }
  Expected<void> announce(Quota& quota, std::uint64_t bytes) {
    return quota.admit(bytes, [&] { ASSERT_TRUE(uploads_.create(TokenId(), bytes, "")); });
  }
  std::size_t objects() const {
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder_.path() / "objects"))
      count += entry.is_regular_file() ? 1 : 0;
    return count;
  }

  test::TemporaryFolder folder_;
  FileStore store_ = FileStore::open(folder_.path() / "objects").value();
  std::unique_ptr<Catalogue> catalogue_ =
      open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  Uploads uploads_{folder_.path() / "uploads", {.bytes = 1 << 20, .per_token = 100}};
  const std::vector<std::uint8_t> file_ = test::tiny_pmesh("the base", "a chunk").bytes;
};

TEST_F(QuotaTest, ConcurrentReservationsNeverExceedTheQuota) {
  const auto quota = quota_of(3'000);
  std::atomic<int> admitted = 0;
  std::vector<std::thread> callers;
  for (int i = 0; i < 8; ++i)
    callers.emplace_back([&] { admitted += announce(*quota, 1'000) ? 1 : 0; });
  for (std::thread& caller : callers)
    caller.join();
  EXPECT_EQ(admitted, 3);
  EXPECT_EQ(uploads_.list().value().size(), 3u);
}

TEST_F(QuotaTest, ARefusalStatesTheSpaceInUse) {
  const auto quota = quota_of(1'000);
  ASSERT_TRUE(announce(*quota, 700));
  const auto refused = announce(*quota, 301);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
  EXPECT_THAT(refused.error().message, HasSubstr("700 of 1000 bytes are taken"));
  EXPECT_TRUE(announce(*quota, 300));
}

TEST_F(QuotaTest, AReservationBlocksOthersUntilItIsReleased) {
  const auto quota = quota_of(1'000);
  const NamedFile file{ModelId(), Sha256{1}, 600}, next{ModelId(), Sha256{2}, 600};
  {
    const auto room = quota->reserve({&file, 1}, std::nullopt);
    ASSERT_TRUE(room);
    EXPECT_FALSE(announce(*quota, 500));
    EXPECT_FALSE(quota->reserve({&next, 1}, std::nullopt));
  }
  EXPECT_TRUE(announce(*quota, 500));
}

TEST_F(QuotaTest, AModelReplacesItsUploadInTheQuota) {
  const auto quota = quota_of(file_.size());
  const UploadId own = uploads_.create(TokenId(), file_.size(), "").value().id;
  EXPECT_EQ(publish(store_, *catalogue_, file_, {}, {.quota = quota.get()}).error().code,
            ErrorCode::kLimit);
  EXPECT_EQ(objects(), 0u);
  EXPECT_TRUE(publish(store_, *catalogue_, file_, {}, {.quota = quota.get(), .upload = own}));
}

TEST_F(QuotaTest, AFileThatSeveralModelsNameCountsOnce) {
  const auto quota = quota_of(file_.size());
  for (const char* title : {"one", "two"})
    EXPECT_TRUE(publish(store_, *catalogue_, file_, {.title = title}, {.quota = quota.get()}));
  EXPECT_FALSE(announce(*quota, 1));
}

TEST_F(QuotaTest, PublicPartsAndReplacementsHaveToFit) {
  const ModelId id = publish(store_, *catalogue_, file_, {}).value().id;
  const auto full = quota_of(file_.size() + 10), roomy = quota_of(3 * file_.size());
  ModelRecord capped = catalogue_->find(id).value().value();
  capped.public_part = PublicPart{.max_level = 0};
  EXPECT_EQ(change(store_, *catalogue_, capped, full.get()).error().code, ErrorCode::kLimit);
  EXPECT_EQ(objects(), 1u);
  const auto other = test::tiny_pmesh("another base", "a chunk").bytes;
  EXPECT_EQ(replace(store_, *catalogue_, other, {}, {.id = id, .quota = full.get()}).error().code,
            ErrorCode::kLimit);
  EXPECT_EQ(objects(), 1u);
  EXPECT_TRUE(change(store_, *catalogue_, capped, roomy.get()));
  const auto both = quota_of(2 * file_.size() + 10);  // too small for the new model's public part
  EXPECT_FALSE(replace(store_, *catalogue_, other, {}, {.id = id, .quota = both.get()}));
}

TEST_F(QuotaTest, WithoutAQuotaEverythingFits) {
  const auto quota = quota_of(0);
  EXPECT_TRUE(announce(*quota, 1 << 20));
  EXPECT_TRUE(publish(store_, *catalogue_, file_, {}, {.quota = quota.get()}));
}

}  // namespace
}  // namespace vitrine::server
