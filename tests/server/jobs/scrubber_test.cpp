// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scrubber.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ScrubberTest : public testing::Test {
 protected:
  ModelId add(const std::string& title) {
    const auto file = test::tiny_pmesh("base of " + title, "chunk");
    return publish(*in_.store, *in_.catalogue, file.bytes, {.title = title}).value().id;
  }
  Sha256 file_of(const ModelId& id) { return in_.catalogue->find(id).value()->file; }
  std::filesystem::path path_of(const Sha256& file) {
    const std::string hex = to_hex(file);
    return folder_.path() / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex;
  }
  void damage(const Sha256& file) {
    std::fstream(path_of(file), std::ios::in | std::ios::out).seekp(-1, std::ios::end).put('!');
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
