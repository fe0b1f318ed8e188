// SPDX-License-Identifier: Apache-2.0
// Tests drafts: who sees them, how a model becomes a draft, and how a draft is published.
#include <gtest/gtest.h>

#include <algorithm>
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

class Drafts : public testing::Test {
 protected:
  HttpAnswer ask(const std::string& path, const std::string& who = "",
                 const std::string& method = "GET") {
    test::HttpClient client(server_.port());
    return client.get(path, who, method);
  }
  TokenId viewers_token() {
    const auto tokens = server_.catalogue().tokens().value();
    return std::ranges::find(tokens, Role::kViewer, &TokenRecord::role)->id;
  }
  HttpAnswer set(const std::string& verb) { return ask(api_ + "/" + verb, operator_, "POST"); }

  test::LocalServer server_{public_routes()};
  const test::TinyPmesh file_ = test::tiny_pmesh("the base", "a chunk");
  const std::string id_ = publish(server_.store(), server_.catalogue(), file_.bytes, {.title = "A"},
                                  {.state = ModelState::kDraft})
                              ->id.to_string();
  const std::string api_ = "/api/v1/models/" + id_;
  const std::string chunk_ = "/chunks/" + to_hex(file_.manifest.chunks[0].sha256);
  const std::string base_ = "/chunks/" + to_hex(file_.manifest.base_sha256);
  const std::string viewer_ = server_.bearer(Role::kViewer);
  const std::string operator_ = server_.bearer(Role::kOperator);
};

TEST_F(Drafts, ADraftIsShownToWhoHasATokenAndNobodyMayKeepIt) {
  for (const std::string& path : {"/models/" + id_, api_, api_ + "/manifest", api_ + "/head",
                                  api_ + "/file.pmesh", api_ + base_, api_ + chunk_}) {
    EXPECT_EQ(ask(path).status, 404) << path;
    const HttpAnswer answer = ask(path, viewer_);
    EXPECT_EQ(answer.status, 200) << path;
    EXPECT_EQ(answer.field("cache-control"), "private, no-store") << path;
    EXPECT_EQ(answer.field("access-control-allow-origin"), "") << path;
  }
  EXPECT_EQ(ask(api_ + chunk_, viewer_).body, "a chunk");
  EXPECT_EQ(ask(api_ + "/chunks/" + std::string(64, 'a'), viewer_).status, 404);
  EXPECT_EQ(json::parse(ask(api_, viewer_).body)["state"], "draft");
  EXPECT_EQ(ask("/api/v1" + chunk_, viewer_).status, 404) << "that URL is for everybody's caches";
}

TEST_F(Drafts, AWithdrawnChunkIsReplacedInCachesThatHaveACopy) {
  ASSERT_EQ(set("publish").status, 200);
  const std::string tag = ask("/api/v1" + chunk_).field("etag");
  ASSERT_EQ(set("unpublish").status, 200);
  const HttpAnswer revalidated = ask("/api/v1" + chunk_, "If-None-Match: " + tag + "\r\n");
  EXPECT_EQ(revalidated.status, 404);
  EXPECT_EQ(revalidated.field("cache-control"), "public, max-age=0, s-maxage=1");
  EXPECT_EQ(ask("/api/v1" + chunk_).field("cache-control"), "no-store");
}

TEST_F(Drafts, ADraftsChunksComeFromMemoryAsLongAsTheTokenIsInForce) {
  const auto& models = server_.services().models;
  ASSERT_EQ(ask(api_ + chunk_, viewer_).body, "a chunk");
  const std::uint64_t opened = models.misses;
  EXPECT_EQ(ask(api_ + chunk_, viewer_).body, "a chunk");
  EXPECT_EQ(models.misses, opened);
  EXPECT_EQ(ask(api_ + "/chunks/" + std::string(64, 'a'), viewer_).status, 404);
  EXPECT_EQ(ask(api_ + chunk_).status, 404) << "without a token there is no such model";
  ASSERT_TRUE(server_.catalogue().revoke_token(viewers_token())) << "as another process does";
  unsigned status = 200;
  while (status == 200)  // a revoked token may be accepted for a tenth of a second
    status = ask(api_ + chunk_, viewer_).status;
  EXPECT_EQ(status, 401);
}

TEST_F(Drafts, ATokenThatIsRevokedHereIsWorthlessAtOnce) {
  const std::string admin = server_.bearer(Role::kAdmin);
  ASSERT_EQ(ask(api_ + chunk_, viewer_).status, 200);
  ASSERT_EQ(ask("/api/v1/tokens/" + viewers_token().to_string(), admin, "DELETE").status, 204);
  EXPECT_EQ(ask(api_ + chunk_, viewer_).status, 401);
}

TEST_F(Drafts, DraftsAreListedForWhoHasATokenAndAsks) {
  const std::string list = "/api/v1/models?drafts=true";
  EXPECT_EQ(ask(list).status, 401);
  const HttpAnswer answer = ask(list, viewer_);
  EXPECT_EQ(answer.field("cache-control"), "private, no-store");
  EXPECT_EQ(json::parse(answer.body)["models"].at(0)["id"], id_);
  EXPECT_TRUE(json::parse(ask("/api/v1/models", viewer_).body)["models"].empty());
  EXPECT_EQ(ask("/api/v1/models?drafts=1", viewer_).status, 400);
}

TEST_F(Drafts, AListForATokenIsForNobodyElseToKeep) {
  ASSERT_TRUE(server_.catalogue().set_state(ModelId::parse(id_).value(), ModelState::kPublished));
  const HttpAnswer open = ask("/api/v1/models");
  EXPECT_EQ(open.field("cache-control"), "no-cache");
  EXPECT_EQ(open.field("access-control-allow-origin"), "*");
  const HttpAnswer own = ask("/api/v1/models", viewer_);
  EXPECT_EQ(json::parse(own.body)["models"].at(0)["id"], id_);
  EXPECT_EQ(own.field("cache-control"), "private, no-store");
  EXPECT_EQ(own.field("access-control-allow-origin"), "");
}

TEST_F(Drafts, AnOperatorPublishesAModelAndTakesItBack) {
  EXPECT_EQ(ask(api_ + "/publish", "", "POST").status, 401);
  EXPECT_EQ(ask(api_ + "/publish", viewer_, "POST").status, 403);
  for (int i = 0; i < 2; ++i) {
    const HttpAnswer published = set("publish");
    EXPECT_EQ(published.status, 200) << published.body;
    EXPECT_EQ(json::parse(published.body)["state"], "published");
    EXPECT_EQ(ask(api_ + "/manifest").status, 200);
    EXPECT_EQ(ask("/api/v1" + chunk_).body, "a chunk");
    EXPECT_EQ(ask(api_ + chunk_).field("cache-control"), "private, no-store");
    EXPECT_EQ(json::parse(ask("/api/v1/models").body)["models"].size(), 1u);
  }
  for (int i = 0; i < 2; ++i) {
    const HttpAnswer hidden = set("unpublish");
    EXPECT_EQ(hidden.status, 200) << hidden.body;
    EXPECT_EQ(json::parse(hidden.body)["state"], "draft");
    EXPECT_EQ(ask(api_ + "/manifest").status, 404) << "at once";
    EXPECT_EQ(ask("/api/v1" + chunk_).status, 404);
  }
  EXPECT_NE(server_.events().find("/unpublish status=200"), std::string::npos);
}

TEST_F(Drafts, WhatIsNotThereIsNotPublished) {
  const std::string other = "/api/v1/models/" + ModelId::generate().to_string();
  EXPECT_EQ(ask(other + "/publish", operator_, "POST").status, 404);
  EXPECT_EQ(ask(other + "/unpublish", operator_, "POST").status, 404);
  EXPECT_EQ(ask(other, viewer_).status, 404);
}

}  // namespace
}  // namespace vitrine::server
