// SPDX-License-Identifier: Apache-2.0
// Tests searches over HTTP: words, facets, sort orders, and the counts of facets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;

class Search : public testing::Test {
 protected:
  void add(const std::string& title, std::map<std::string, std::string> more,
           ModelState state = ModelState::kPublished) {
    const auto file = test::tiny_pmesh("the base of " + title, "a chunk");
    ASSERT_TRUE(publish(server_.store(), server_.catalogue(), file.bytes,
                        {.title = title, .more = std::move(more)}, {.state = state}));
  }
  HttpAnswer ask(const std::string& path, const std::string& who = "") {
    test::HttpClient client(server_.port());
    return client.get("/api/v1" + path, who);
  }
  std::vector<std::string> titles(const std::string& query) {
    std::vector<std::string> all;
    const json page = json::parse(ask("/models" + query).body);
    for (const json& model : page["models"])
      all.push_back(model["title"].get<std::string>());
    return all;
  }

  test::LocalServer server_{public_routes()};
};

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(Search, WordsFacetsAndOrdersAreParameters) {
  add("Torso", {{"material", "marble"}, {"place", "Mérida"}});
  add("Bust", {{"material", "marble; bronze"}});
  add("Coin", {{"material", "bronze"}});
  EXPECT_THAT(titles("?sort=title"), ElementsAre("Bust", "Coin", "Torso"));
  EXPECT_THAT(titles("?sort=oldest"), ElementsAre("Torso", "Bust", "Coin"));
  EXPECT_THAT(titles("?q=merid"), ElementsAre("Torso"));
  EXPECT_THAT(titles("?material=bronze&sort=title"), ElementsAre("Bust", "Coin"));
  EXPECT_THAT(titles("?material=bronze&q=coin"), ElementsAre("Coin"));
  EXPECT_THAT(titles("?material=wood"), IsEmpty());
}

TEST_F(Search, AnOrderContinuesOnTheNextPage) {
  for (const char* title : {"C", "A", "B"})
    add(title, {});
  const json page = json::parse(ask("/models?sort=title&limit=2").body);
  EXPECT_EQ(page["models"].at(1)["title"], "B");
  EXPECT_THAT(titles("?sort=title&limit=2&cursor=" + page["next"].get<std::string>()),
              ElementsAre("C"));
}

TEST_F(Search, FacetsAreCountedForTheSameSearch) {
  add("Torso", {{"material", "marble"}});
  add("Bust", {{"material", "marble; bronze"}, {"period", "Hellenistic"}});
  const json all = json::parse(ask("/facets").body);
  EXPECT_EQ(all["models"], 2);
  EXPECT_EQ(all["facets"]["material"],
            json::parse(R"([{"value": "marble", "models": 2}, {"value": "bronze", "models": 1}])"));
  EXPECT_EQ(all["facets"]["subject"], json::array()) << "a facet without values is there, too";
  const json narrow = json::parse(ask("/facets?q=bust&material=marble").body);
  EXPECT_EQ(narrow["models"], 1);
  EXPECT_EQ(narrow["facets"]["period"].at(0)["value"], "Hellenistic");
}

TEST_F(Search, FacetsCountDraftsOnlyForWhoHasATokenAndAsks) {
  add("Secret", {{"material", "unobtainium"}}, ModelState::kDraft);
  const std::string viewer = server_.bearer(Role::kViewer);
  EXPECT_EQ(ask("/facets?drafts=true").status, 401);
  for (const char* query : {"", "?q=secret", "?material=unobtainium"}) {
    const HttpAnswer open = ask(std::string("/facets") + query);
    EXPECT_EQ(json::parse(open.body)["models"], 0) << query;
    EXPECT_EQ(open.body.find("unobtainium"), std::string::npos) << query;
    EXPECT_EQ(json::parse(ask(std::string("/facets") + query, viewer).body)["models"], 0) << query;
  }
  EXPECT_EQ(ask("/facets").field("cache-control"), "no-cache");
  const HttpAnswer own = ask("/facets?drafts=true", viewer);
  EXPECT_EQ(json::parse(own.body)["facets"]["material"].at(0)["value"], "unobtainium");
  EXPECT_EQ(own.field("cache-control"), "private, no-store");
  EXPECT_EQ(own.field("access-control-allow-origin"), "");
}

TEST_F(Search, WrongParametersAreNamed) {
  const HttpAnswer order = ask("/models?sort=size");
  EXPECT_EQ(order.status, 400);
  EXPECT_THAT(order.body, HasSubstr("one of newest, oldest, title, creator"));
  EXPECT_EQ(ask("/facets?sort=title").status, 400) << "counts have no order";
  EXPECT_EQ(ask("/facets?limit=3").status, 400);
  EXPECT_EQ(ask("/facets?q=" + std::string(201, 'a')).status, 400);
  EXPECT_EQ(ask("/facets?drafts=1").status, 400);
}

}  // namespace
}  // namespace vitrine::server
