// SPDX-License-Identifier: Apache-2.0
// Tests that a collection has a page and an IIIF collection while a published model belongs to it.
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

using ::testing::HasSubstr;
using ::testing::Not;

class Collections : public testing::Test {
 protected:
  void SetUp() override {
    const auto file = test::tiny_pmesh("the base", "a chunk").bytes;
    const ModelMetadata texts{.title = "Krater", .more = {{"collection", "Vases & jugs; Clay"}}};
    model_ = publish(server_.store(), server_.catalogue(), file, texts)->id;
  }
  test::HttpAnswer get(const std::string& path) { return test::http_get(server_.port(), path); }

  const std::string page_ = "/collections/Vases%20%26%20jugs";
  const std::string iiif_ = "/api/v1/iiif/collection.json?collection=Vases%20%26%20jugs";
  test::LocalServer server_{public_routes()};
  ModelId model_;
};

TEST_F(Collections, HaveAPageWithTheirModels) {
  const auto answer = get(page_);
  EXPECT_EQ(answer.status, 200);
  EXPECT_THAT(answer.body, HasSubstr(page_ + "\">"));
  EXPECT_THAT(answer.field("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
  EXPECT_EQ(get("/collections/Clay").status, 200);
}

TEST_F(Collections, HaveAnIiifCollection) {
  const auto json = nlohmann::json::parse(get(iiif_).body);
  EXPECT_THAT(json["id"].get<std::string>(), testing::EndsWith(iiif_));
  EXPECT_EQ(json["type"], "Collection");
  EXPECT_EQ(json["label"]["none"][0], "Vases & jugs");
  ASSERT_EQ(json["items"].size(), 1u);
  EXPECT_THAT(json["items"][0]["id"].get<std::string>(), HasSubstr(model_.to_string()));
}

TEST_F(Collections, AreListedInTheSitemap) {
  const std::string sitemap = get("/sitemap.xml").body;
  EXPECT_THAT(sitemap, HasSubstr(page_ + "</loc>"));
  EXPECT_THAT(sitemap, HasSubstr("/collections/Clay</loc>"));
}

TEST_F(Collections, DisappearWithTheirLastPublishedModel) {
  ASSERT_TRUE(server_.catalogue().set_state(model_, ModelState::kDraft));
  EXPECT_EQ(get(page_).status, 404);
  EXPECT_EQ(get(iiif_).status, 404);
  EXPECT_THAT(get("/sitemap.xml").body, Not(HasSubstr("/collections/")));
}

TEST_F(Collections, HaveNamesThatAreWellFormed) {
  for (const char* path : {"/collections/", "/collections/%", "/collections/%2", "/collections/x",
                           "/collections/Clay/x"})
    EXPECT_EQ(get(path).status, 404) << path;
}

}  // namespace
}  // namespace vitrine::server
