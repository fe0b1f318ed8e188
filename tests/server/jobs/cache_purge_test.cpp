// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/cache_purge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/jobs/scrubber.h"
#include "server/store/change.h"
#include "server/store/installation.h"
#include "support/damage_object.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"
#include "support/webhook_listener.h"

namespace vitrine::server {
namespace {

using test::WebhookListener;
using testing::HasSubstr;
using testing::StartsWith;

std::string cache_url(const WebhookListener& cache) {
  return "http://" + cache.host();
}

std::string purge_of(const Sha256& chunk) {
  return "PURGE /api/v1/chunks/" + to_hex(chunk) + " HTTP/1.1\r\n";
}

class CachePurges : public testing::Test {
 protected:
  ModelId publish(const test::TinyPmesh& file) {
    return server::publish(*installation_.store, *installation_.catalogue, file.bytes,
                           {.title = "A"})
        ->id;
  }
  // Returns a CachePurge for `caches`. The catalogue notifies it of hidden chunks.
  std::unique_ptr<CachePurge> purge(std::vector<std::string> caches) {
    auto made = std::make_unique<CachePurge>(std::move(caches), *installation_.catalogue, events_);
    installation_.catalogue->when_hidden(
        [to = made.get()](std::vector<Sha256> chunks) { to->forget_hidden(std::move(chunks)); });
    return made;
  }
  std::string events() const {
    std::ifstream in(folder_.path() / "events.log");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::TemporaryFolder folder_;
  Installation installation_ = open_installation({.folder = folder_.path()}).value();
  Log events_ = Log::open(folder_.path() / "events.log").value();
  const test::TinyPmesh first_ = test::tiny_pmesh("a base", "a chunk");
  const test::TinyPmesh second_ = test::tiny_pmesh("a base", "another chunk");
};

TEST_F(CachePurges, EachCacheForgetsTheChunksThatNoPublishedModelHas) {
  WebhookListener left, right;
  const ModelId withdrawn = publish(first_);
  publish(second_);  // shares its base mesh with the first model
  const auto purging = purge({cache_url(left), cache_url(right)});
  ASSERT_TRUE(installation_.catalogue->set_state(withdrawn, ModelState::kDraft));
  const std::string wanted = purge_of(first_.manifest.chunks[0].sha256);
  EXPECT_THAT(left.hear("200 OK"), StartsWith(wanted));
  EXPECT_THAT(right.hear("404 Not Found"), StartsWith(wanted));
}

TEST_F(CachePurges, ARemovedModelIsForgottenWhole) {
  WebhookListener cache;
  const ModelId removed = publish(first_);
  const auto purging = purge({cache_url(cache)});
  ASSERT_TRUE(remove(*installation_.store, *installation_.catalogue, removed, std::nullopt));
  const std::string all = cache.hear("200 OK") + cache.hear("200 OK");
  EXPECT_THAT(all, HasSubstr(purge_of(first_.manifest.base_sha256)));
  EXPECT_THAT(all, HasSubstr(purge_of(first_.manifest.chunks[0].sha256)));
}

TEST_F(CachePurges, TheChunksOfADamagedFileAreForgottenThoughTheyArePublic) {
  WebhookListener cache;
  const ModelId damaged = publish(first_);
  publish(second_);
  const auto purging = purge({cache_url(cache)});
  test::damage_object(folder_.path(), installation_.catalogue->find(damaged).value()->file);
  PublishedModels models(*installation_.store, *installation_.catalogue);
  Scrubber scrubber({.store = *installation_.store,
                     .catalogue = *installation_.catalogue,
                     .models = models,
                     .catalogue_faults = [] { return std::vector<std::string>(); },
                     .events = events_,
                     .forget = [&](auto chunks) { purging->forget(std::move(chunks)); }});
  ASSERT_TRUE(scrubber.check_all());
  const std::string all = cache.hear("200 OK") + cache.hear("200 OK");
  EXPECT_THAT(all, HasSubstr(purge_of(first_.manifest.base_sha256)));
  EXPECT_THAT(all, HasSubstr(purge_of(first_.manifest.chunks[0].sha256)));
}

TEST_F(CachePurges, ACacheThatRefusesIsNamedAndNotAskedAgain) {
  WebhookListener cache;
  const ModelId removed = publish(first_);
  auto purging = purge({cache_url(cache)});
  ASSERT_TRUE(remove(*installation_.store, *installation_.catalogue, removed, std::nullopt));
  cache.hear("405 Method Not Allowed");
  while (events().empty())
    std::this_thread::yield();
  EXPECT_THAT(events(), HasSubstr("cache " + cache_url(cache) + " was not purged"));
  EXPECT_THAT(events(), HasSubstr("405"));
}

}  // namespace
}  // namespace vitrine::server
