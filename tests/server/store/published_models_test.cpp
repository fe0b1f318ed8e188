// SPDX-License-Identifier: Apache-2.0
// Tests the cache of published models: its size, the lifetime of its entries, and which of several
// callers opens a model.
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <thread>
#include <utility>

#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/change.h"
#include "server/store/file_store.h"
#include "server/store/publish.h"
#include "server/store/published_model.h"
#include "support/forwarding/catalogue_before.h"
#include "support/forwarding/store_before.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

// A store that counts opened objects, and can delay opening and checks, or let opening fail.
class WatchedStore final : public test::StoreBefore {
 public:
  using StoreBefore::StoreBefore;

  Expected<std::unique_ptr<Object>> open(const Sha256& name) const override {
    ++opened;
    before_opening();
    if (is_away) return fail(ErrorCode::kIo, "the store is away");
    return before_.open(name);
  }

  mutable std::atomic<int> opened{0};
  bool keeps_copies() const override { return copies; }
  Expected<ObjectState> check(const Sha256& name, const OnPiece& on_piece) const override {
    before_checking();
    return before_.check(name, on_piece);
  }

  std::function<void()> before_opening = [] {}, before_checking = [] {};
  bool is_away = false, copies = false;
};

class PublishedModelsTest : public testing::Test {
 protected:
  ModelId add(const std::string& chunk, const std::string& title = "") {
    const test::TinyPmesh file = test::tiny_pmesh("the base of " + chunk, chunk);
    return publish(store_, *catalogue_, file.bytes, {.title = title}).value().id;
  }
  static Sha256 name_of(const std::string& chunk) { return sha256(test::to_bytes(chunk)); }
  const PublishedModel* get(const ModelId& id) { return models_.find(id).value().get(); }

  test::TemporaryFolder folder_;
  FileStore files_ = FileStore::open(folder_.path() / "objects").value();
  WatchedStore store_{files_};
  std::unique_ptr<Catalogue> catalogue_ =
      open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  PublishedModels models_{store_, *catalogue_, std::chrono::milliseconds(0)};
};

TEST_F(PublishedModelsTest, AChangeDropsOnlyTheChangedModel) {
  const ModelId one = add("one"), two = add("two"), three = add("three");
  store_.opened = 0;
  const auto first = get(one), third = get(three);
  const auto second = models_.find(two).value();
  ModelRecord record = catalogue_->find(two).value().value();
  record.title = "another";
  ASSERT_TRUE(catalogue_->update(record, std::nullopt));
  ASSERT_TRUE(catalogue_->remove(three, std::nullopt));
  ASSERT_TRUE(catalogue_->add_token({.id = TokenId::generate(), .role = Role::kAdmin}));
  EXPECT_EQ(get(one), first);
  EXPECT_EQ(get(two)->record().title, "another");
  EXPECT_EQ(get(three), nullptr);
  EXPECT_NE(third, nullptr);
  EXPECT_EQ(store_.opened, 4);
}

TEST_F(PublishedModelsTest, TheLeastRecentlyUsedModelIsDropped) {
  const ModelId one = add("one"), two = add("two"), three = add("three");
  get(one);
  models_.set_capacity(models_.bytes() * 2);
  get(two);
  get(one);
  get(three);
  EXPECT_EQ(models_.misses, 3u);
  get(one);
  get(three);
  EXPECT_EQ(models_.misses, 3u);
  get(two);
  EXPECT_EQ(models_.misses, 4u);
  EXPECT_EQ(models_.hits, 3u);
}

TEST_F(PublishedModelsTest, ACachedManifestCountsAndOneWithoutSpaceIsNotKept) {
  const auto model = models_.find(add("one")).value();
  const std::uint64_t before = models_.bytes();
  models_.set_capacity(before + 2'000);
  const auto keep = [&](std::size_t text, std::size_t gzip) {
    models_.keep_manifest(model, std::make_shared<const Document>(Document{
                                     std::string(text, ' '), "", std::vector<std::uint8_t>(gzip)}));
  };
  keep(3'000, 0);
  EXPECT_FALSE(model->kept_manifest());
  keep(1'000, 2'000);
  EXPECT_FALSE(model->kept_manifest());
  keep(500, 500);
  EXPECT_TRUE(model->kept_manifest());
  EXPECT_GE(models_.bytes(), before + 1'000);
  models_.set_capacity(before);
  EXPECT_EQ(models_.bytes(), 0u);
}

TEST_F(PublishedModelsTest, AModelAboveTheCapacityIsServedAndNotKept) {
  const ModelId id = add("one");
  models_.set_capacity(10);
  EXPECT_TRUE(get(id));
  EXPECT_TRUE(get(id));
  EXPECT_EQ(models_.misses, 2u);
  EXPECT_EQ(models_.bytes(), 0u);
}

TEST_F(PublishedModelsTest, AChunkOfTwoModelsStaysWhileOneOfThemDoes) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  const ModelId one = add("same", "one"), two = add("same", "two");
  ASSERT_TRUE(lazy.find(one).value());
  const std::uint64_t bytes = lazy.bytes();
  ASSERT_TRUE(lazy.find(two).value());
  lazy.set_capacity(bytes);
  const auto chunk = lazy.cached_chunk(name_of("same"));
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->model->record().id, two);
}

TEST_F(PublishedModelsTest, AWholeModelIsCachedForCallersThatMaySeeIt) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  const ModelId id = add("one");
  ASSERT_TRUE(catalogue_->set_state(id, ModelState::kDraft));
  store_.opened = 0;
  EXPECT_EQ(lazy.cached_whole(id), nullptr);
  const auto draft = lazy.find_whole(id).value();
  ASSERT_TRUE(draft);
  EXPECT_EQ(lazy.find_whole(id).value(), draft);
  EXPECT_EQ(lazy.cached_whole(id), draft);
  EXPECT_EQ(store_.opened, 1);
  EXPECT_EQ(lazy.cached(id), nullptr);
  EXPECT_FALSE(lazy.cached_chunk(name_of("one")));
  EXPECT_EQ(lazy.find(id).value(), nullptr);
  ASSERT_TRUE(catalogue_->remove(id, std::nullopt));
  lazy.refresh();
  EXPECT_EQ(lazy.cached_whole(id), nullptr);
  EXPECT_EQ(lazy.find_whole(id).value(), nullptr);
}

TEST_F(PublishedModelsTest, ACallerWaitsForAModelThatIsBeingOpened) {
  constexpr int kVisitors = 4;
  const ModelId id = add("one");
  std::latch here(kVisitors);
  store_.opened = 0;
  store_.before_opening = [&] { here.wait(); };
  std::vector<std::jthread> visitors;
  for (int i = 0; i < kVisitors; ++i) {
    visitors.emplace_back([&] {
      here.count_down();
      EXPECT_TRUE(models_.find(id).value());
    });
  }
  visitors.clear();
  EXPECT_EQ(store_.opened, 1);
}

TEST_F(PublishedModelsTest, AFailureIsSharedUntilItIsStaleOrSomethingChanges) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  const ModelId id = add("one");
  store_.is_away = true;
  store_.opened = 0;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(lazy.find(id).error().code, ErrorCode::kIo);
  EXPECT_EQ(store_.opened, 1);
  for (int i = 0; i < 3; ++i)
    EXPECT_FALSE(models_.find(id));  // this cache keeps a failure for 0 ms
  EXPECT_EQ(store_.opened, 4);
  store_.is_away = false;
  EXPECT_FALSE(lazy.find(id));
  EXPECT_TRUE(models_.find(id).value());
  lazy.refresh();
  EXPECT_TRUE(lazy.find(id).value());
}

TEST_F(PublishedModelsTest, AFileThatIsCollectedBeforeItIsOpenWasAnOldRecords) {
  const ModelId one = add("one"), two = add("two");
  const test::TinyPmesh newer = test::tiny_pmesh("another base", "another");
  bool is_first = true;
  const auto before_the_first = [&](const ModelId& id, const auto& change) {
    is_first = true;
    store_.before_opening = [&, id, change] {
      if (!std::exchange(is_first, false)) return;
      const Sha256 old = catalogue_->find(id).value()->file;
      change();
      ASSERT_TRUE(store_.remove(old));
    };
  };
  before_the_first(
      one, [&] { ASSERT_TRUE(replace(store_, *catalogue_, newer.bytes, {}, {.id = one})); });
  EXPECT_EQ(models_.find(one).value()->record().file, sha256(newer.bytes));
  before_the_first(two, [&] { ASSERT_TRUE(catalogue_->remove(two, std::nullopt)); });
  EXPECT_EQ(models_.find_whole(two).value(), nullptr);
}

TEST_F(PublishedModelsTest, AModelThatIsHiddenWhileItIsReplacedIsReplacedAndHidden) {
  const ModelId id = add("one");
  const test::TinyPmesh newer = test::tiny_pmesh("another base", "another");
  bool is_first = true;
  store_.before_checking = [&] {
    if (!std::exchange(is_first, false)) return;
    ASSERT_TRUE(catalogue_->set_state(id, ModelState::kDraft));
  };
  ASSERT_TRUE(
      replace(store_, *catalogue_, newer.bytes, {}, {.state = ModelState::kDraft, .id = id}));
  const auto record = catalogue_->find(id).value();
  EXPECT_EQ(record->file, sha256(newer.bytes));
  EXPECT_EQ(record->state, ModelState::kDraft);
}

TEST_F(PublishedModelsTest, AFileThatIsLostIsAFault) {
  const ModelId id = add("one");
  ASSERT_TRUE(store_.remove(catalogue_->find(id).value()->file));
  EXPECT_EQ(models_.find(id).error().code, ErrorCode::kState);
}

TEST_F(PublishedModelsTest, ADamagedFileIsReadOnceAndServedAgainOnceItIsMended) {
  const ModelId id = add("one"), other = add("two");
  const Sha256 file = catalogue_->find(id).value()->file;
  const auto bytes = store_.open(file).value()->read(0, catalogue_->find(id).value()->file_bytes);
  ASSERT_TRUE(store_.remove(file));
  EXPECT_EQ(models_.find(id).error().code, ErrorCode::kState);
  EXPECT_EQ(models_.damaged(), std::vector{file});
  store_.opened = 0;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(models_.find_chunk(name_of("one")).error().code, ErrorCode::kState);
    EXPECT_EQ(models_.find_whole(id).error().code, ErrorCode::kState);
  }
  EXPECT_EQ(store_.opened, 0);
  EXPECT_TRUE(get(other));
  ASSERT_TRUE(store_.put(file, *bytes));
  ASSERT_TRUE(catalogue_->set_state(id, ModelState::kPublished));
  EXPECT_TRUE(get(id));
  EXPECT_TRUE(models_.damaged().empty());
}

TEST_F(PublishedModelsTest, AChunkComesFromAnotherModelIfTheFileOfOneIsDamaged) {
  const auto add_with = [&](const std::string& base) {
    const auto file = test::tiny_pmesh(base, "shared").bytes;
    return std::pair(publish(store_, *catalogue_, file, {.title = base}).value().id, file);
  };
  const std::vector files = {add_with("one base"), add_with("another base")};
  const Sha256 chunk = name_of("shared");
  for (const std::size_t damaged : {0, 1}) {
    const auto& [lost, bytes] = files[damaged];
    const ModelId& intact = files[1 - damaged].first;
    ASSERT_TRUE(store_.remove(sha256(bytes)));
    PublishedModels models(store_, *catalogue_);
    const auto found = models.find_chunk(chunk);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(found->model);
    EXPECT_EQ(found->model->record().id, intact);
    models.set_damaged(sha256(bytes));
    EXPECT_EQ(models.model_with(chunk).value(), intact) << "it is opened before the request";
    PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
    ASSERT_TRUE(lazy.revision());
    add("other " + std::to_string(damaged));
    EXPECT_TRUE(lazy.find_chunk(chunk)) << "although the catalogue has changed since";
    ASSERT_TRUE(store_.put(sha256(bytes), bytes));
  }
  for (const auto& [id, bytes] : files)
    ASSERT_TRUE(store_.remove(sha256(bytes)));
  EXPECT_EQ(models_.find_chunk(chunk).error().code, ErrorCode::kState);
}

TEST_F(PublishedModelsTest, AMendedFileIsServedAtOnceThoughTheCacheIsOlder) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  const ModelId id = add("one");
  const Sha256 file = catalogue_->find(id).value()->file;
  const auto bytes = store_.open(file).value()->read(0, catalogue_->find(id).value()->file_bytes);
  ASSERT_TRUE(store_.remove(file));
  EXPECT_EQ(lazy.find(id).error().code, ErrorCode::kState);
  ASSERT_TRUE(store_.put(file, *bytes));
  ASSERT_TRUE(catalogue_->set_state(id, ModelState::kPublished));
  EXPECT_TRUE(lazy.find(id).value());
}

TEST_F(PublishedModelsTest, AFileThatIsFoundDamagedIsServedNoMore) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  const ModelId id = add("one"), other = add("two");
  ASSERT_TRUE(lazy.find(id).value() && lazy.find(other).value());
  ASSERT_TRUE(lazy.cached_chunk(name_of("one")));
  const Sha256 file = catalogue_->find(id).value()->file;
  lazy.set_damaged(file);
  EXPECT_EQ(lazy.cached(id), nullptr);
  EXPECT_FALSE(lazy.cached_chunk(name_of("one")));
  EXPECT_EQ(lazy.find(id).error().code, ErrorCode::kState);
  EXPECT_TRUE(lazy.cached(other));
  lazy.set_intact(file);
  EXPECT_TRUE(lazy.find(id).value());
}

TEST_F(PublishedModelsTest, AModelIsKeptThoughAnotherChangesWhileItOpens) {
  const ModelId id = add("one");
  store_.before_opening = [&, is_first = true]() mutable {
    if (!std::exchange(is_first, false)) return;
    add("two");
    ASSERT_TRUE(models_.revision());
  };
  const auto* const first = get(id);
  EXPECT_EQ(get(id), first);
  EXPECT_EQ(models_.misses, 1u);
}

TEST_F(PublishedModelsTest, AModelThatChangesWhileItOpensIsNotKept) {
  const ModelId id = add("one");
  store_.before_opening = [&, is_first = true]() mutable {
    if (!std::exchange(is_first, false)) return;
    ModelRecord record = catalogue_->find(id).value().value();
    record.title = "another";
    ASSERT_TRUE(catalogue_->update(record, std::nullopt));
    ASSERT_TRUE(models_.revision());
  };
  get(id);
  EXPECT_EQ(get(id)->record().title, "another");
}

TEST_F(PublishedModelsTest, AModelWhoseCopyIsFoundDamagedWhileItOpensIsNotKept) {
  const ModelId id = add("one");
  store_.before_opening = [&, is_first = true]() mutable {
    if (!std::exchange(is_first, false)) return;
    models_.drop_copies(catalogue_->find(id).value()->file);
  };
  EXPECT_EQ(models_.find(id).value()->damages(), 0u);
  EXPECT_EQ(models_.find(id).value()->damages(), 1u);
}

TEST_F(PublishedModelsTest, NobodyWaitsForAFileThatIsDamagedOrThatTheCacheCannotHold) {
  const ModelId id = add("one");
  const Sha256 file = catalogue_->find(id).value()->file;
  ASSERT_TRUE(models_.revision());
  EXPECT_EQ(models_.unopened(id, false), file);
  models_.set_damaged(file);
  EXPECT_EQ(models_.unopened(id, false), std::nullopt);
  models_.set_intact(file);
  models_.set_capacity(0);
  EXPECT_EQ(models_.unopened(id, false), std::nullopt);
  models_.set_capacity(1);
  EXPECT_EQ(models_.unopened(id, false), file) << "its size is not known yet";
  EXPECT_TRUE(get(id));
  EXPECT_EQ(models_.unopened(id, false), std::nullopt);
  models_.set_capacity(UINT64_MAX);
  EXPECT_EQ(models_.unopened(id, false), file);
}

TEST_F(PublishedModelsTest, DroppedCopiesCountAsDamagedAndTheFileIsOpenedAgain) {
  const ModelId id = add("one");
  const Sha256 file = catalogue_->find(id).value()->file;
  const auto first = models_.find(id).value();
  EXPECT_EQ(models_.damages_of(file), first->damages());
  const ModelsRevision before = models_.revision().value();
  models_.drop_copies(file);
  EXPECT_EQ(models_.damages_of(file), first->damages() + 1);
  EXPECT_NE(models_.revision().value(), before);
  EXPECT_TRUE(models_.damaged().empty());
  EXPECT_EQ(models_.unopened(id, false), file);
  EXPECT_EQ(get(id)->damages(), models_.damages_of(file));
}

TEST_F(PublishedModelsTest, TheCatalogueIsAskedInTheBackground) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::milliseconds(400));
  std::vector<std::function<void()>> tasks;
  lazy.refresh_by([&](std::function<void()> task) { tasks.push_back(std::move(task)); });
  add("one");
  std::optional<PublishedChunk> found;
  while (tasks.empty()) {
    found = lazy.cached_chunk(name_of("one"));
    if (!found) {
      ASSERT_TRUE(lazy.find_chunk(name_of("one")).value().model);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(found) << "who comes when it is due does not wait";
  lazy.cached_chunk(name_of("one"));
  EXPECT_EQ(tasks.size(), 1u) << "once for all";
  tasks.front()();
}

class LimitedCopiesTest : public PublishedModelsTest {
 protected:
  LimitedCopiesTest() {
    store_.copies = true;
    models_.limit_copies_to([this] { return room_; });
  }
  std::uint64_t size_of(const ModelId& id) { return catalogue_->find(id).value()->file_bytes; }

  const ModelId one_ = add("one"), two_ = add("two");
  std::uint64_t room_ = UINT64_MAX;
};

TEST_F(LimitedCopiesTest, TheLeastRecentlyUsedModelMakesRoomOnTheDisk) {
  const ModelId big = add("the big one");
  get(one_);
  get(two_);
  get(one_);
  room_ = size_of(big) - 1;
  EXPECT_TRUE(get(big));
  models_.misses = 0;
  get(one_);
  EXPECT_EQ(models_.misses, 0u) << "it was used after the other";
  room_ = UINT64_MAX;
  get(two_);
  EXPECT_EQ(models_.misses, 1u);
}

TEST_F(LimitedCopiesTest, ACopyThatDoesNotFitIsRefusedAndDropsNothing) {
  get(one_);
  room_ = 0;
  const ModelId big = add(std::string(5'000, 'b'));
  const auto refused = models_.find(big);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_NE(refused.error().message.find("free some space, or lower disk-reserve"),
            std::string::npos);
  EXPECT_EQ(models_.misses, 2u);
  get(one_);
  EXPECT_EQ(models_.misses, 2u) << "it stays open";
  room_ = size_of(big);
  EXPECT_TRUE(get(big)) << "the refused copy takes no room";
}

TEST_F(LimitedCopiesTest, AModelThatIsBeingSentMakesNoRoom) {
  const auto sent = models_.find(one_).value();
  room_ = size_of(two_) - 1;
  EXPECT_FALSE(models_.find(two_));
  models_.misses = 0;
  EXPECT_EQ(get(one_), sent.get());
  EXPECT_EQ(models_.misses, 0u) << "it stays open for other visitors";
  room_ = size_of(two_);
  EXPECT_TRUE(models_.find(two_));
}

TEST_F(LimitedCopiesTest, AModelThatNobodyHoldsMakesRoomBeforeOneThatIsBeingSent) {
  const ModelId big = add("the big one");
  const auto sent = models_.find(one_).value();
  get(two_);
  room_ = size_of(big) - 1;
  EXPECT_TRUE(get(big));
  room_ = UINT64_MAX;
  models_.misses = 0;
  EXPECT_EQ(get(one_), sent.get());
  EXPECT_EQ(models_.misses, 0u);
  get(two_);
  EXPECT_EQ(models_.misses, 1u);
}

// A catalogue that calls a function once, before it looks up a model.
class InterruptedCatalogue final : public test::CatalogueBefore {
 public:
  using CatalogueBefore::CatalogueBefore;
  Expected<std::optional<ModelRecord>> find(const ModelId& id) override {
    if (const auto interrupt = std::exchange(before_finding, nullptr)) interrupt();
    return before_.find(id);
  }

  std::function<void()> before_finding;
};

TEST_F(LimitedCopiesTest, AModelThatIsCheckedForChangesMakesRoom) {
  InterruptedCatalogue catalogue(*catalogue_);
  PublishedModels models(store_, catalogue, std::chrono::milliseconds(0));
  models.limit_copies_to([this] { return room_; });
  ASSERT_TRUE(models.find(one_));
  add("a change of the catalogue");
  room_ = size_of(two_) - 1;
  bool is_open = false;
  catalogue.before_finding = [&] { is_open = models.find(two_).has_value(); };
  ASSERT_TRUE(models.revision());
  EXPECT_TRUE(is_open);
}

TEST_F(LimitedCopiesTest, CopiesInProgressCount) {
  room_ = size_of(one_) + size_of(two_) - 1;
  store_.before_opening = [&, is_first = true]() mutable {
    if (std::exchange(is_first, false)) {
      EXPECT_FALSE(models_.find(two_));
    }
  };
  EXPECT_TRUE(models_.find(one_));
  EXPECT_TRUE(models_.find(two_));
}

TEST_F(LimitedCopiesTest, AStoreThatOpensItsOwnFilesNeedsNoRoom) {
  store_.copies = false;
  room_ = 0;
  EXPECT_TRUE(get(one_));
}

// A catalogue that can be made unreachable.
class DistantCatalogue final : public test::CatalogueBefore {
 public:
  using CatalogueBefore::CatalogueBefore;
  Expected<std::uint64_t> revision() override {
    if (is_away) return fail(ErrorCode::kIo, "the catalogue is away; wait for it");
    return before_.revision();
  }

  std::atomic<bool> is_away{false};
};

TEST_F(PublishedModelsTest, CachedModelsAreServedWhileTheCatalogueIsUnreachable) {
  DistantCatalogue distant(*catalogue_);
  PublishedModels models(store_, distant, std::chrono::milliseconds(0));
  const ModelId held = add("held"), other = add("other");
  ASSERT_TRUE(models.find(held).value());
  distant.is_away = true;
  EXPECT_TRUE(models.find(held).value());
  EXPECT_TRUE(models.find_chunk(name_of("held")).value().model);
  EXPECT_FALSE(models.find(other));
  distant.is_away = false;
  EXPECT_TRUE(models.find(other).value());
}

TEST_F(PublishedModelsTest, AModelHiddenHereIsNotShownWhileTheCatalogueIsUnreachable) {
  DistantCatalogue distant(*catalogue_);
  PublishedModels models(store_, distant, std::chrono::milliseconds(0));
  const ModelId id = add("one");
  ASSERT_TRUE(models.find(id).value());
  ASSERT_TRUE(catalogue_->set_state(id, ModelState::kDraft));
  models.refresh();
  distant.is_away = true;
  EXPECT_FALSE(models.find(id));
}

}  // namespace
}  // namespace vitrine::server
