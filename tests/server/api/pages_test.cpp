// SPDX-License-Identifier: Apache-2.0
// Tests the policies that browsers enforce for the daemon's pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/api/routes.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Pages : public testing::Test {
 protected:
  test::HttpAnswer get(const std::string& path) {
    test::HttpAnswer answer = test::http_get(server_.port(), path);
    EXPECT_EQ(answer.status, 200) << path;
    return answer;
  }

  test::LocalServer server_{kPages.routes};
};

TEST_F(Pages, OfWhateverNameHaveOnePolicyAndNoOtherSiteFramesThem) {
  for (const char* path : {"/console", "/console.html"}) {
    const auto answer = get(path);
    EXPECT_THAT(answer.field("content-security-policy"), HasSubstr("; frame-ancestors 'none'"));
    EXPECT_EQ(answer.field("x-frame-options"), "DENY") << path;
  }
}

TEST_F(Pages, TheViewerMayBeFramedByEverySite) {
  const test::TinyPmesh file = test::tiny_pmesh("the base", "a chunk");
  const std::string id =
      publish(server_.store(), server_.catalogue(), file.bytes, {.title = "A"})->id.to_string();
  for (const std::string& path : {std::string("/model.html"), "/models/" + id}) {
    const auto answer = get(path);
    EXPECT_THAT(answer.field("content-security-policy"), Not(HasSubstr("frame-ancestors")));
    EXPECT_EQ(answer.field("x-frame-options"), "") << path;
  }
}

TEST_F(Pages, ConnectToTheirOwnOriginOnly) {
  for (const char* path : {"/console", "/model.html"})
    EXPECT_THAT(get(path).field("content-security-policy"), HasSubstr("; connect-src 'self';"));
}

TEST_F(Pages, RunNoInlineStylesAndScripts) {
  for (const char* path : {"/console", "/model.html"}) {
    const auto policy = get(path).field("content-security-policy");
    EXPECT_THAT(policy, HasSubstr("; style-src 'self';"));
    EXPECT_THAT(policy, Not(HasSubstr("unsafe-inline")));
  }
}

TEST_F(Pages, AnErrorIsAPageForABrowserAndJsonForAProgram) {
  const auto ask = [&](const std::string& accept) {
    test::HttpClient client(server_.port());
    client.send("GET /nowhere HTTP/1.1\r\nHost: a\r\nAccept: " + accept + "\r\n\r\n");
    return client.receive();
  };
  const auto page = ask("text/html,*/*;q=0.8");
  EXPECT_EQ(page.status, 404);
  EXPECT_THAT(page.field("content-type"), HasSubstr("text/html"));
  EXPECT_THAT(page.field("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
  EXPECT_EQ(ask("*/*").field("content-type"), "application/problem+json");
}

TEST_F(Pages, SearchEnginesFindThePublishedModelsOnly) {
  const test::TinyPmesh file = test::tiny_pmesh("the base", "a chunk");
  const auto id = publish(server_.store(), server_.catalogue(), file.bytes, {.title = "A"})->id;
  EXPECT_THAT(get("/robots.txt").body, HasSubstr("Disallow: /console\n"));
  EXPECT_THAT(get("/robots.txt").body, HasSubstr("/sitemap.xml\n"));
  EXPECT_THAT(get("/sitemap.xml").body, HasSubstr("/models/" + id.to_string() + "</loc>"));
  ASSERT_TRUE(server_.catalogue().set_state(id, ModelState::kDraft));
  EXPECT_THAT(get("/sitemap.xml").body, Not(HasSubstr(id.to_string())));
}

}  // namespace
}  // namespace vitrine::server
