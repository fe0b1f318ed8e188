// SPDX-License-Identifier: Apache-2.0
// Tests the daemon's pages: the policies that browsers enforce, error pages, and sitemaps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "server/api/routes.h"
#include "server/catalogue/sqlite.h"
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
  const test::TinyPmesh file = test::tiny_pmesh("the base", "a chunk");
  ASSERT_TRUE(publish(server_.store(), server_.catalogue(), file.bytes,
                      {.title = "A", .more = {{"collection", "Vases"}}}));
  const auto policy = get("/console").field("content-security-policy");
  EXPECT_THAT(policy, HasSubstr("; frame-ancestors 'none'"));
  for (const char* path :
       {"/", "/index.html", "/collections/Vases", "/compare.html", "/console", "/console.html",
        "/docs", "/docs.html", "/scan.html", "/scans/01arz3ndektsv4rrffq69g5fav"}) {
    const auto answer = get(path);
    EXPECT_THAT(answer.field("content-type"), HasSubstr("text/html")) << path;
    EXPECT_EQ(answer.field("content-security-policy"), policy) << path;
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

class Gallery : public Pages {
 protected:
  ModelId publish_as(const std::string& title) {
    return publish(server_.store(), server_.catalogue(), file_.bytes, {.title = title})->id;
  }
  test::HttpAnswer get_unless(const std::string& tag) {
    return test::HttpClient(server_.port()).get("/", "If-None-Match: " + tag + "\r\n");
  }

  const test::TinyPmesh file_ = test::tiny_pmesh("the base", "a chunk");
};

TEST_F(Gallery, ListsThePublishedModelsInItsHtml) {
  const std::string vase = publish_as("Vase <b>& jug</b>").to_string();
  const ModelId draft = publish_as("Draft");
  ASSERT_TRUE(server_.catalogue().set_state(draft, ModelState::kDraft));
  const std::string html = get("/").body;
  EXPECT_THAT(html, HasSubstr("<h1 id=\"title\">Collection</h1>"));
  EXPECT_THAT(html, HasSubstr("<ul id=\"models\"><li><a href=\"/models/" + vase + "\">"));
  EXPECT_THAT(html, HasSubstr("<h2>Vase &lt;b&gt;&amp; jug&lt;/b&gt;</h2>"));
  EXPECT_THAT(html, HasSubstr("<img src=\"/api/v1/models/" + vase + "/poster.png\" "));
  EXPECT_THAT(html, HasSubstr("/api/v1/iiif/collection.json\">"));
  EXPECT_THAT(html, Not(HasSubstr(draft.to_string())));
}

TEST_F(Gallery, HasATagThatChangesWithItsModels) {
  publish_as("Vase");
  const std::string tag = get("/").field("etag");
  EXPECT_EQ(get_unless(tag).status, 304);
  publish_as("Jug");
  const auto changed = get_unless(tag);
  EXPECT_EQ(changed.status, 200);
  EXPECT_NE(changed.field("etag"), tag);
}

TEST_F(Gallery, LeavesTheListToItsScriptIfItSearchesOrIfTheCatalogueFails) {
  const std::string id = publish_as("Vase").to_string();
  EXPECT_THAT(get("/?q=jug").body, Not(HasSubstr(id)));
  sqlite::SqliteHandle(server_.data() / kCatalogueFile).run("ALTER TABLE model RENAME TO gone");
  EXPECT_EQ(get("/").body, get("/index.html").body);
}

// A collection with one model and 10,000 newer copies of its record.
class LargeCollection : public testing::Test {
 protected:
  void SetUp() override {
    const test::TinyPmesh file = test::tiny_pmesh("the base", "a chunk");
    oldest_ =
        publish(server_.store(), server_.catalogue(), file.bytes, {.title = "A"})->id.to_string();
    sqlite::SqliteHandle(server_.data() / kCatalogueFile)
        .run(
            "CREATE TEMP TABLE copy AS WITH RECURSIVE k(i) AS (VALUES(1) UNION ALL "
            "SELECT i + 1 FROM k WHERE i < 10000) SELECT model.* FROM model, k;"
            "UPDATE copy SET id = CAST(printf('0%015d', rowid) AS BLOB);"
            "INSERT INTO model SELECT * FROM copy;");
  }
  std::string get(const std::string& path) {
    const test::HttpAnswer answer = test::http_get(server_.port(), path);
    EXPECT_EQ(answer.status, 200) << path;
    return answer.body;
  }
  // Returns the path part of an address that begins with "http://localhost:PORT".
  static std::string path_of(const std::string& address) {
    return address.substr(address.find('/', std::string_view("http://").size()));
  }

  test::LocalServer server_{public_routes()};
  std::string oldest_;
};

// Returns the texts of all <loc> elements.
std::vector<std::string> addresses_in(std::string_view xml) {
  constexpr std::string_view kBegin = "<loc>", kEnd = "</loc>";
  std::vector<std::string> all;
  for (std::size_t at = 0; (at = xml.find(kBegin, at)) != xml.npos;) {
    at += kBegin.size();
    all.emplace_back(xml.substr(at, xml.find(kEnd, at) - at));
  }
  return all;
}

TEST_F(LargeCollection, HasAnIndexOfSitemapsWithEveryModelOnce) {
  const std::string index = get("/sitemap.xml");
  EXPECT_THAT(index, HasSubstr("<sitemapindex "));
  const auto sitemaps = addresses_in(index);
  ASSERT_EQ(sitemaps.size(), 2u);
  const auto first = addresses_in(get(path_of(sitemaps[0]))),
             second = addresses_in(get(path_of(sitemaps[1])));
  EXPECT_EQ(std::set(first.begin(), first.end()).size(), 10'001u);
  EXPECT_EQ(path_of(first[0]), "/");
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(path_of(second[0]), "/models/" + oldest_);
}

TEST_F(LargeCollection, IsAnIiifCollectionOfCollections) {
  const auto read = [&](const std::string& path) { return nlohmann::json::parse(get(path)); };
  const auto top = read("/api/v1/iiif/collection.json");
  ASSERT_EQ(top["items"].size(), 2u);
  std::set<std::string> manifests;
  for (const auto& item : top["items"]) {
    EXPECT_EQ(item["type"], "Collection");
    const auto part = read(path_of(item["id"]));
    EXPECT_EQ(part["id"], item["id"]);
    EXPECT_EQ(part["partOf"][0]["id"], top["id"]);
    for (const auto& manifest : part["items"])
      manifests.insert(path_of(manifest["id"]));
  }
  EXPECT_EQ(manifests.size(), 10'001u);
  EXPECT_TRUE(manifests.contains("/api/v1/iiif/" + oldest_ + "/manifest.json"));
}

TEST_F(LargeCollection, NamesAFaultyCursor) {
  for (const char* path : {"/sitemap.xml?cursor=x", "/api/v1/iiif/collection.json?cursor=x"})
    EXPECT_EQ(test::http_get(server_.port(), path).status, 400) << path;
}

}  // namespace
}  // namespace vitrine::server
