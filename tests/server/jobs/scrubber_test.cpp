// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scrubber.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/store/file_object.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/damage_object.h"
#include "support/forwarding/store_before.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A store that opens local copies of its objects, as a store in a bucket does.
class CopyingStore final : public test::StoreBefore {
 public:
  CopyingStore(ObjectStore& store, std::filesystem::path copy)
      : StoreBefore(store), copy_(std::move(copy)) {}

  Expected<std::unique_ptr<Object>> open(const Sha256& name) const override {
    const auto object = before_.open(name);
    if (!object || *object == nullptr) return nullptr;
    const auto bytes = (*object)->read(0, (*object)->size()).value();
    std::filesystem::remove(copy_);
    std::ofstream(copy_, std::ios::binary) << std::string(bytes.begin(), bytes.end());
    return object_in(FileDescriptor(::open(copy_.c_str(), O_RDONLY | O_CLOEXEC)), bytes.size());
  }
  bool keeps_copies() const override { return true; }

 private:
  const std::filesystem::path copy_;
};

// A store whose objects consist of kPieces pieces. Each piece has as many bytes as the scrubber
// reads in a second at its default rate.
class StoreInPieces final : public test::StoreBefore {
 public:
  static constexpr std::size_t kPieces = 5;

  using StoreBefore::StoreBefore;
  Expected<ObjectState> check(const Sha256&, const OnPiece& on_piece) const override {
    for (std::size_t i = 0; i < kPieces; ++i) {
      if (!on_piece(Scrubber::kDefaultRate))
        return tl::unexpected(Error{ErrorCode::kIo, "stopped"});
    }
    return ObjectState::kIntact;
  }
};

class ScrubberTest : public testing::Test {
 protected:
  ModelId add(const std::string& title) {
    const auto file = test::tiny_pmesh("base of " + title, "chunk");
    return publish(*in_.store, *in_.catalogue, file.bytes, {.title = title}).value().id;
  }
  Sha256 file_of(const ModelId& id) { return in_.catalogue->find(id).value()->file; }
  void damage(const Sha256& file) { test::damage_object(folder_.path(), file); }
  std::filesystem::path path_of(const Sha256& file) {
    const std::string hex = to_hex(file);
    return folder_.path() / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex;
  }
  std::string log() {
    std::ifstream in(folder_.path() / "log");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::TemporaryFolder folder_;
  Installation in_ = open_installation({.folder = folder_.path()}).value();
  PublishedModels models_{*in_.store, *in_.catalogue};
  Log events_ = Log::open(folder_.path() / "log").value();
  std::vector<std::string> faults_;
  Scrubber scrubber_{
      {.store = *in_.store,
       .catalogue = *in_.catalogue,
       .models = models_,
       .catalogue_faults = [this] { return Expected<std::vector<std::string>>(faults_); },
       .events = events_}};
};

TEST_F(ScrubberTest, ADamagedAndALostObjectAreFoundLoggedAndServedNoMore) {
  const ModelId sound = add("sound"), damaged = add("damaged"), lost = add("lost");
  for (const ModelId& id : {sound, damaged, lost})
    ASSERT_TRUE(models_.find(id).value());
  damage(file_of(damaged));
  std::filesystem::remove(path_of(file_of(lost)));
  EXPECT_TRUE(scrubber_.check_all());
  EXPECT_EQ(scrubber_.objects, 3u);
  EXPECT_GT(scrubber_.finished, 0);
  EXPECT_THAT(models_.damaged(), testing::UnorderedElementsAre(file_of(damaged), file_of(lost)));
  EXPECT_THAT(log(), HasSubstr(to_hex(file_of(damaged)) + " of model " + damaged.to_string() +
                               " is damaged"));
  EXPECT_THAT(log(),
              HasSubstr(to_hex(file_of(lost)) + " of model " + lost.to_string() + " is missing"));
  EXPECT_FALSE(models_.find(damaged));
  EXPECT_FALSE(models_.find(lost));
  EXPECT_TRUE(models_.find(sound));
}

TEST_F(ScrubberTest, ADamagedLocalCopyIsLoadedAgain) {
  const auto bytes = test::tiny_pmesh("base of vase", "chunk").bytes;
  const ModelId id = add("vase");
  const auto copy = folder_.path() / "copy";
  const CopyingStore store(*in_.store, copy);
  PublishedModels models(store, *in_.catalogue);
  Scrubber scrubber({.store = store,
                     .catalogue = *in_.catalogue,
                     .models = models,
                     .catalogue_faults = [] { return std::vector<std::string>(); },
                     .events = events_});
  const auto first = models.find(id).value();
  EXPECT_TRUE(scrubber.check_all());
  EXPECT_EQ(models.find(id).value(), first) << "an intact copy stays open";
  std::fstream(copy, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(-1, std::ios::end)
      .put('x');
  EXPECT_TRUE(scrubber.check_all());
  const auto second = models.find(id).value();
  EXPECT_EQ(second->file().read(0, bytes.size()).value(), bytes);
  EXPECT_NE(second->damages(), first->damages()) << "caches may have parts of the damaged copy";
  EXPECT_THAT(models.damaged(), IsEmpty());
  EXPECT_THAT(log(), HasSubstr("the local copy of object " + to_hex(file_of(id)) + " was damaged"));
}

TEST_F(ScrubberTest, AnObjectThatWasPutBackIsServedAgain) {
  const auto bytes = test::tiny_pmesh("base of vase", "chunk").bytes;
  const ModelId id = add("vase");
  damage(file_of(id));
  scrubber_.check_all();
  scrubber_.check_damaged();
  EXPECT_FALSE(models_.find(id));
  ASSERT_TRUE(in_.store->put(sha256(bytes), bytes));
  scrubber_.check_damaged();
  EXPECT_THAT(models_.damaged(), IsEmpty());
  EXPECT_TRUE(models_.find(id));
}

TEST_F(ScrubberTest, ADamagedObjectThatNoModelNeedsIsForgotten) {
  const ModelId id = add("vase");
  const Sha256 file = file_of(id);
  damage(file);
  scrubber_.check_all();
  ASSERT_THAT(models_.damaged(), ElementsAre(file));
  ASSERT_TRUE(in_.catalogue->remove(id, std::nullopt));
  scrubber_.check_damaged();
  EXPECT_THAT(models_.damaged(), IsEmpty());
}

TEST_F(ScrubberTest, FaultsOfTheCatalogueAreCountedAndLogged) {
  scrubber_.check_all();
  EXPECT_EQ(scrubber_.catalogue_faults, 0u);
  EXPECT_THAT(log(), Not(HasSubstr("damaged")));
  faults_ = {"page 7 is torn", "page 9 is torn"};
  scrubber_.check_all();
  EXPECT_EQ(scrubber_.catalogue_faults, 2u);
  EXPECT_THAT(log(), HasSubstr("the catalogue is damaged: page 7 is torn"));
  faults_ = {};
  scrubber_.check_all();
  EXPECT_EQ(scrubber_.catalogue_faults, 0u);
}

TEST_F(ScrubberTest, EachPieceIsWaitedForAsTheRateDemands) {
  add("vase");
  add("bust");
  std::vector<std::chrono::steady_clock::time_point> waits;
  const StoreInPieces store(*in_.store);
  Scrubber scrubber({.store = store,
                     .catalogue = *in_.catalogue,
                     .models = models_,
                     .catalogue_faults = [] { return std::vector<std::string>(); },
                     .events = events_,
                     .wait_until =
                         [&](auto time) {
                           waits.push_back(time);
                           return true;
                         }});
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(scrubber.check_all());
  EXPECT_EQ(scrubber.bytes, 2 * StoreInPieces::kPieces * Scrubber::kDefaultRate);
  ASSERT_EQ(waits.size(), 2 * StoreInPieces::kPieces);
  EXPECT_GE(waits.front() - start, std::chrono::seconds(1));
  for (std::size_t i = 1; i < waits.size(); ++i)
    EXPECT_GE(waits[i] - waits[i - 1], std::chrono::seconds(1)) << i;
}

TEST_F(ScrubberTest, AStopDoesNotWaitForTheRate) {
  add("vase");
  scrubber_.start(1);           // one byte per second
  while (scrubber_.bytes == 0)  // waits until the thread has read a piece
    std::this_thread::yield();
  scrubber_.stop();
  EXPECT_EQ(scrubber_.finished, 0);
}

}  // namespace
}  // namespace vitrine::server
