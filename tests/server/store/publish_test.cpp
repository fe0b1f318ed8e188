// SPDX-License-Identifier: Apache-2.0
#include "server/store/publish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/change.h"
#include "server/store/file_store.h"
#include "server/store/installation.h"
#include "server/store/published_model.h"
#include "support/forwarding/catalogue_before.h"
#include "support/held_lock.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

class Publish : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  FileStore store_ = FileStore::open(folder_.path() / "objects").value();
  std::unique_ptr<Catalogue> catalogue_ =
      open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  PublishedModels models_{store_, *catalogue_, milliseconds(0)};
  test::TinyPmesh file_ = test::tiny_pmesh("the base", "a chunk");

  Bytes served(const Sha256& chunk) {
    const auto found = models_.find_chunk(chunk).value();
    return found.model ? found.model->read(found.range).value() : Bytes{};
  }
  std::size_t object_count() const {
    const auto objects = std::filesystem::recursive_directory_iterator(folder_.path() / "objects");
    return static_cast<std::size_t>(
        std::ranges::count_if(objects, [](const auto& entry) { return entry.is_regular_file(); }));
  }
  std::size_t model_count() {
    return catalogue_->search({.includes_drafts = true}).value().models.size();
  }
};

// A catalogue on a full disk: no model can be added.
class FullCatalogue final : public test::CatalogueBefore {
 public:
  using test::CatalogueBefore::CatalogueBefore;
  Expected<void> add(const ModelRecord&, std::span<const ChunkPlace>,
                     const std::optional<JobClaim>&) override {
    return fail(ErrorCode::kLimit, "the disk is full; free some space");
  }
};

// Simulates a change of the catalogue by another client at a critical moment. find_chunk_after()
// calls `change` after it has looked up the chunk, and before it returns the result.
class HastyCatalogue final : public test::CatalogueBefore {
 public:
  HastyCatalogue(Catalogue& before, std::function<void()> change)
      : test::CatalogueBefore(before), change_(std::move(change)) {}
  Expected<std::optional<ChunkLocation>> find_chunk_after(const Sha256& chunk,
                                                          const ModelId& after) override {
    auto found = before_.find_chunk_after(chunk, after);
    change_();
    return found;
  }

 private:
  const std::function<void()> change_;
};

TEST_F(Publish, APublishedModelServesItsHeadItsChunksAndItsFile) {
  const auto id = publish(store_, *catalogue_, file_.bytes, {.title = "A head"});
  ASSERT_TRUE(id) << id.error().message;
  const auto model = models_.find(id->id).value();
  ASSERT_TRUE(model);
  EXPECT_EQ(model->record().title, "A head");
  EXPECT_EQ(model->record().unit, "mm");
  EXPECT_EQ(model->record().faces, 8u);
  EXPECT_EQ(model->read(model->whole()).value(), file_.bytes);
  EXPECT_EQ(model->read(model->base()).value(), test::to_bytes("the base"));
  EXPECT_EQ(model->read(model->chunk(0)).value(), test::to_bytes("a chunk"));
  EXPECT_EQ(model->head().length, file_.manifest.head_bytes());
}

TEST_F(Publish, BaseAndChunksAreFoundByHashBeforeTheModelWasOpened) {
  ASSERT_TRUE(publish(store_, *catalogue_, file_.bytes, {}));
  EXPECT_EQ(served(sha256(test::to_bytes("a chunk"))), test::to_bytes("a chunk"));
  EXPECT_EQ(served(sha256(test::to_bytes("the base"))), test::to_bytes("the base"));
  EXPECT_EQ(served(sha256(test::to_bytes("another"))), Bytes{});
}

TEST_F(Publish, AtlasAndPicturesAreFoundByHashBeforeAndAfterTheModelWasOpened) {
  const auto textured = test::tiny_pmesh("the base", "a chunk", {"a picture", "a larger picture"});
  ASSERT_TRUE(publish(store_, *catalogue_, textured.bytes, {}));
  for (const char* opened : {"before", "after"}) {
    for (const char* block : {"the atlas", "a picture", "a larger picture", "a chunk"})
      EXPECT_EQ(served(sha256(test::to_bytes(block))), test::to_bytes(block)) << opened;
  }
  EXPECT_EQ(served(sha256(test::to_bytes("another picture"))), Bytes{});
}

TEST_F(Publish, ALimitedModelKeepsTheAtlasAndThePicturesOfTheHead) {
  const auto textured = test::tiny_pmesh("the base", "a chunk", {"a picture", "a larger picture"});
  const ModelId id = publish(store_, *catalogue_, textured.bytes, {}).value().id;
  const auto limit = [&](std::optional<PublicPart> part) {
    ModelRecord model = catalogue_->find(id).value().value();
    model.public_part = part;
    ASSERT_TRUE(change(store_, *catalogue_, model));
  };
  limit(PublicPart{.max_level = 0});
  const auto part = models_.find(id).value();
  EXPECT_EQ(part->manifest().texture.pictures.size(), 1u);
  for (const char* kept : {"the base", "the atlas", "a picture"})
    EXPECT_EQ(served(sha256(test::to_bytes(kept))), test::to_bytes(kept));
  for (const char* hidden : {"a chunk", "a larger picture"})
    EXPECT_EQ(served(sha256(test::to_bytes(hidden))), Bytes{}) << hidden;
  const auto whole = models_.find_whole(id).value();
  EXPECT_EQ(whole->read(whole->whole()).value(), textured.bytes);
  limit(PublicPart{.max_level = 1});
  EXPECT_EQ(served(sha256(test::to_bytes("a larger picture"))), test::to_bytes("a larger picture"));
}

TEST_F(Publish, AChunkOfAModelThatIsReplacedMeanwhileIsThatChunkOrNone) {
  const ModelId id = publish(store_, *catalogue_, file_.bytes, {}).value().id;
  const auto same_chunk = test::tiny_pmesh("a longer base", "a chunk").bytes;
  const auto other_chunk = test::tiny_pmesh("the base", "a chink").bytes;
  for (const auto& [next, expected] :
       {std::pair(same_chunk, test::to_bytes("a chunk")), std::pair(other_chunk, Bytes{})}) {
    HastyCatalogue hasty(*catalogue_, [&, &next = next] {
      ASSERT_TRUE(replace(store_, *catalogue_, next, {}, {.id = id}));
    });
    PublishedModels models(store_, hasty);
    const auto found = models.find_chunk(sha256(test::to_bytes("a chunk"))).value();
    EXPECT_EQ(found.model ? found.model->read(found.range).value() : Bytes{}, expected);
  }
}

TEST_F(Publish, ADamagedFileIsServedWholeOnceItWasPublishedAgain) {
  const ModelId id = publish(store_, *catalogue_, file_.bytes, {}).value().id;
  const Sha256 chunk = sha256(test::to_bytes("a chunk"));
  std::filesystem::path path;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(folder_.path() / "objects"))
    if (entry.is_regular_file()) path = entry.path();
  std::fstream(path, std::ios::in | std::ios::out | std::ios::ate | std::ios::binary)
      .seekp(-1, std::ios::end)
      .put('!');
  EXPECT_EQ(models_.find_chunk(chunk).error().code, ErrorCode::kState);
  EXPECT_EQ(publish(store_, *catalogue_, file_.bytes, {}).value().id, id);
  EXPECT_EQ(served(chunk), test::to_bytes("a chunk"));
}

TEST_F(Publish, AnObjectThatLosesItsNameIsKeptForTheGracePeriod) {
  constexpr std::chrono::hours kGrace{1};
  const auto unnamed = [&] {  // sweeps, and returns the number of removed objects
    const auto files = catalogue_->files().value();
    std::set<Sha256> named;
    for (const NamedFile& file : files)
      named.insert(file.file);
    return store_.sweep(named, kGrace, test::kHeld).value();
  };
  const auto grow_old = [&] {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder_.path() / "objects"))
      if (entry.is_regular_file())
        std::filesystem::last_write_time(
            entry.path(), std::filesystem::file_time_type::clock::now() - 2 * kGrace);
  };
  const ModelId id = publish(store_, *catalogue_, file_.bytes, {}).value().id;
  const auto change_to = [&](std::optional<PublicPart> part) {
    ModelRecord model = catalogue_->find(id).value().value();
    model.public_part = part;
    grow_old();
    ASSERT_TRUE(change(store_, *catalogue_, model));
  };
  change_to(PublicPart{.max_level = 0});
  change_to(std::nullopt);
  EXPECT_EQ(unnamed(), 0u) << "what was public of it";
  grow_old();
  EXPECT_EQ(unnamed(), 1u);
  const auto other = test::tiny_pmesh("another base", "a chunk").bytes;
  grow_old();
  ASSERT_TRUE(replace(store_, *catalogue_, other, {}, {.id = id}));
  EXPECT_EQ(unnamed(), 0u) << "what was replaced";
  grow_old();
  EXPECT_EQ(unnamed(), 1u);
  grow_old();
  const std::uint64_t version = catalogue_->find(id).value().value().version;
  EXPECT_EQ(remove(store_, *catalogue_, id, version - 1).error().code, ErrorCode::kState);
  EXPECT_TRUE(catalogue_->find(id).value());
  ASSERT_TRUE(remove(store_, *catalogue_, id, version));
  EXPECT_EQ(unnamed(), 0u) << "what was removed";
  grow_old();
  EXPECT_EQ(unnamed(), 1u);
  EXPECT_EQ(remove(store_, *catalogue_, id, std::nullopt).error().code, ErrorCode::kState);
}

TEST_F(Publish, ADamagedChunkIsRefusedAndNoModelAppears) {
  file_.bytes.back() ^= 1;
  const auto id = publish(store_, *catalogue_, file_.bytes, {});
  ASSERT_FALSE(id);
  EXPECT_EQ(id.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(model_count(), 0u);
  EXPECT_EQ(object_count(), 0u);
}

TEST_F(Publish, ADamagedPictureIsRefusedAndNoModelAppears) {
  auto textured = test::tiny_pmesh("the base", "a chunk", {"a picture", "a larger picture"});
  textured.bytes.back() ^= 1;
  const auto id = publish(store_, *catalogue_, textured.bytes, {});
  ASSERT_FALSE(id);
  EXPECT_EQ(id.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(model_count(), 0u);
  EXPECT_EQ(object_count(), 0u);
}

TEST_F(Publish, ACatalogueThatRefusesLeavesNoObjectBehind) {
  FullCatalogue full(*catalogue_);
  const auto refused = publish(store_, full, file_.bytes, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "the disk is full; free some space");
  EXPECT_EQ(object_count(), 0u);
}

TEST_F(Publish, ACatalogueThatRefusesTakesNoObjectFromAnotherModel) {
  const auto first = publish(store_, *catalogue_, file_.bytes, {.title = "one"});
  ASSERT_TRUE(first);
  FullCatalogue full(*catalogue_);
  ASSERT_FALSE(publish(store_, full, file_.bytes, {.title = "two"}));
  EXPECT_EQ(object_count(), 1u);
  EXPECT_EQ(served(sha256(test::to_bytes("a chunk"))), test::to_bytes("a chunk"));
}

TEST_F(Publish, AFileThatIsCutOffOrTooLongIsRefused) {
  file_.bytes.pop_back();
  EXPECT_FALSE(publish(store_, *catalogue_, file_.bytes, {}));
  file_.bytes.insert(file_.bytes.end(), 2, 'x');
  EXPECT_FALSE(publish(store_, *catalogue_, file_.bytes, {}));
  EXPECT_EQ(model_count(), 0u);
}

TEST_F(Publish, TextThatIsNotUtf8OrIsEndlessIsRefused) {
  EXPECT_FALSE(publish(store_, *catalogue_, file_.bytes, {.title = "caf\xE9"}));
  EXPECT_FALSE(publish(store_, *catalogue_, file_.bytes, {.title = "\xC0\xAF"}));
  EXPECT_FALSE(publish(store_, *catalogue_, file_.bytes, {.creator = std::string(100'000, 'a')}));
  EXPECT_TRUE(publish(store_, *catalogue_, file_.bytes, {.title = "café 🏺"}));
  EXPECT_EQ(model_count(), 1u);
}

TEST_F(Publish, TwoOpeningsOfADataFolderShareTheirModels) {
  const auto first = open_installation({.folder = folder_.path() / "data"}).value();
  const auto second = open_installation({.folder = folder_.path() / "data"}).value();
  const ModelId id = publish(*first.store, *first.catalogue, file_.bytes, {}).value().id;
  PublishedModels models(*second.store, *second.catalogue);
  EXPECT_TRUE(models.find(id).value());
}

TEST_F(Publish, TheSameFileUnderAnotherTitleIsAnotherModel) {
  const auto first = publish(store_, *catalogue_, file_.bytes, {.title = "one"});
  const auto second = publish(store_, *catalogue_, file_.bytes, {.title = "two"});
  ASSERT_TRUE(first && second);
  EXPECT_NE(first->id, second->id);
  EXPECT_EQ(models_.find(second->id).value()->record().title, "two");
}

TEST_F(Publish, TheSameFileUnderTheSameTitleIsTheSameModel) {
  const auto first = publish(store_, *catalogue_, file_.bytes, {.title = "one"});
  const auto again = publish(store_, *catalogue_, file_.bytes, {.title = "one"});
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->id, again->id);
  EXPECT_TRUE(first->is_new);
  EXPECT_FALSE(again->is_new);
  EXPECT_EQ(model_count(), 1u);
}

TEST_F(Publish, RepairsStayUntilAnotherBuildOfTheFileOrAnotherFileHasOwnOnes) {
  const auto publish_with = [&](const std::string& repairs) {
    return publish(store_, *catalogue_, file_.bytes, {}, {.repairs = repairs}).value().id;
  };
  const ModelId id = publish_with("");
  const auto repairs = [&] { return catalogue_->find(id).value().value().repairs; };
  EXPECT_EQ(repairs(), "");
  EXPECT_EQ(publish_with("1 face dropped"), id);
  EXPECT_EQ(repairs(), "1 face dropped");
  EXPECT_EQ(publish_with(""), id) << "the file alone";
  EXPECT_EQ(repairs(), "1 face dropped");
  const auto other = test::tiny_pmesh("another base", "a chunk").bytes;
  ASSERT_TRUE(replace(store_, *catalogue_, other, {}, {.id = id, .repairs = "2 faces dropped"}));
  EXPECT_EQ(repairs(), "2 faces dropped");
  ASSERT_TRUE(replace(store_, *catalogue_, file_.bytes, {}, {.id = id}));
  EXPECT_EQ(repairs(), "");
}

TEST_F(Publish, AModelHiddenByAnotherProcessIsServedNoMore) {
  const ModelId id = publish(store_, *catalogue_, file_.bytes, {}).value().id;
  ASSERT_TRUE(models_.find(id).value());
  const auto other = open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  ASSERT_TRUE(other->set_state(id, ModelState::kDraft));
  EXPECT_FALSE(models_.find(id).value());
  EXPECT_EQ(served(sha256(test::to_bytes("a chunk"))), Bytes{});
}

TEST_F(Publish, AModelPublishedByAnotherProcessIsFoundWhateverIsCached) {
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  EXPECT_FALSE(lazy.find(ModelId::generate()).value());
  const auto other = open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  const ModelId id = publish(store_, *other, file_.bytes, {}).value().id;
  EXPECT_TRUE(lazy.find(id).value());
  EXPECT_TRUE(lazy.find_chunk(sha256(test::to_bytes("a chunk"))).value().model);
}

TEST_F(Publish, AChunkIsCachedAfterItsFirstRequestWhileTheCacheIsFresh) {
  const Sha256 chunk = sha256(test::to_bytes("a chunk"));
  PublishedModels lazy(store_, *catalogue_, std::chrono::hours(1));
  ASSERT_TRUE(publish(store_, *catalogue_, file_.bytes, {}));
  EXPECT_FALSE(lazy.cached_chunk(chunk));
  EXPECT_TRUE(lazy.find_chunk(chunk).value().model);
  EXPECT_TRUE(lazy.cached_chunk(chunk));
  EXPECT_TRUE(models_.find_chunk(chunk).value().model);
  EXPECT_FALSE(models_.cached_chunk(chunk)) << "stale at once";
}

TEST_F(Publish, AModelWhoseObjectIsLostIsAnErrorThatNamesIt) {
  const ModelId id = publish(store_, *catalogue_, file_.bytes, {}).value().id;
  std::filesystem::remove_all(folder_.path() / "objects");
  const auto model = models_.find(id);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kState);
  EXPECT_NE(model.error().message.find(id.to_string()), std::string::npos);
}

}  // namespace
}  // namespace vitrine::server
