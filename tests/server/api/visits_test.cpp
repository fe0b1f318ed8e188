// SPDX-License-Identifier: Apache-2.0
// Tests that visits are counted, and who may read the counts.
#include <fmt/format.h>
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
using testing::HasSubstr;
using testing::Not;

class VisitsApi : public testing::Test {
 protected:
  VisitsApi() { set_counting(true); }

  void set_counting(bool is_counting) {
    Settings settings = server_.settings().get();
    settings.counts_visits = is_counting;
    server_.settings().replace(settings);
  }
  HttpAnswer ask(const std::string& path, const std::string& who = "",
                 const std::string& method = "GET") {
    test::HttpClient client(server_.port());
    return client.get(path, who, method);
  }
  int report(const std::string& query) { return ask(api_ + "/visits" + query, "", "POST").status; }
  // Returns the models in the list of visits.
  json listed(const std::string& query = "") {
    return json::parse(ask("/api/v1/visits" + query, viewer_).body).at("models");
  }

  test::LocalServer server_{public_routes()};
  const test::TinyPmesh file_ = test::tiny_pmesh("the base", "a chunk");
  const std::uint32_t finest_ = static_cast<std::uint32_t>(file_.manifest.levels.size() - 1);
  const ModelId id_ =
      publish(server_.store(), server_.catalogue(), file_.bytes, {.title = "=A \"bust\", old"}, {})
          ->id;
  const std::string api_ = "/api/v1/models/" + id_.to_string();
  const std::string viewer_ = server_.bearer(Role::kViewer);
};

TEST_F(VisitsApi, AVisitIsCountedWithItsTimeAndLevel) {
  EXPECT_EQ(report("?seconds=40&level=0"), 204);
  EXPECT_EQ(report(fmt::format("?seconds=20&level={}", finest_)), 204);
  const json all = listed();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0], (json{{"model", id_.to_string()},
                          {"title", "=A \"bust\", old"},
                          {"visits", 2},
                          {"seconds", 60},
                          {"mean_level", finest_ / 2.0},
                          {"complete", 1}}));
}

TEST_F(VisitsApi, AVisitLeavesNoLineInTheAuditLog) {
  EXPECT_EQ(report("?seconds=40&level=0"), 204);
  EXPECT_EQ(report("?seconds=-1&level=0"), 400);
  ask(api_, viewer_, "DELETE");  // a change that is audited, though it is refused
  ask(api_);                     // once this request is answered, all earlier ones are logged
  ask(api_);
  EXPECT_THAT(server_.events(), HasSubstr("event=audit"));
  EXPECT_THAT(server_.events(), Not(HasSubstr("/visits")));
}

TEST_F(VisitsApi, ALaterReportOfAVisitIsNoOtherVisit) {
  EXPECT_EQ(report("?seconds=1&level=0"), 204);
  EXPECT_EQ(report(fmt::format("?seconds=2&level={}&previous=0", finest_)), 204);
  EXPECT_EQ(report(fmt::format("?seconds=3&level={0}&previous={0}", finest_)), 204);
  const json all = listed();
  EXPECT_EQ(all[0]["visits"], 1);
  EXPECT_EQ(all[0]["seconds"], 6);
  EXPECT_EQ(all[0]["mean_level"], finest_);
  EXPECT_EQ(all[0]["complete"], 1);
}

TEST_F(VisitsApi, AReportOutOfRangeIsRefused) {
  const std::string beyond = std::to_string(finest_ + 1);
  for (const std::string& query :
       {std::string(), std::string("?seconds=1"), std::string("?level=0"),
        std::string("?seconds=-1&level=0"), std::string("?seconds=86401&level=0"),
        std::string("?seconds=1.5&level=0"), "?seconds=1&level=" + beyond,
        std::string("?seconds=1&level=0&previous=1"), std::string("?seconds=1&level=0&who=me")})
    EXPECT_EQ(report(query), 400) << query;
  EXPECT_TRUE(listed().empty());
}

TEST_F(VisitsApi, OnlyPublicModelsAreCounted) {
  ASSERT_EQ(report("?seconds=1&level=0"), 204);
  ASSERT_TRUE(server_.catalogue().set_state(id_, ModelState::kDraft));
  server_.services().models.refresh();
  EXPECT_EQ(report("?seconds=1&level=0"), 404);
  EXPECT_EQ(ask(api_ + "/visits?seconds=1&level=0", viewer_, "POST").status, 404);
  EXPECT_EQ(listed().at(0)["visits"], 1) << "earlier visits stay";
  ASSERT_TRUE(server_.catalogue().remove(id_, {}));
  EXPECT_TRUE(listed().empty());
}

TEST_F(VisitsApi, NothingIsCountedOrAskedForIfTheSettingIsOff) {
  const HttpAnswer counting = ask(api_);
  EXPECT_EQ(json::parse(counting.body)["links"]["visits"], api_ + "/visits");
  EXPECT_EQ(json::parse(ask("/api/v1/visits", viewer_).body)["counted"], true);
  set_counting(false);
  const HttpAnswer silent = ask(api_);
  EXPECT_FALSE(json::parse(silent.body)["links"].contains("visits"));
  EXPECT_NE(silent.field("etag"), counting.field("etag"));
  EXPECT_EQ(report("?seconds=1&level=0"), 404);
  EXPECT_EQ(json::parse(ask("/api/v1/visits", viewer_).body)["counted"], false);
  EXPECT_TRUE(listed().empty());
}

TEST_F(VisitsApi, TheCountsNeedAToken) {
  for (const char* path : {"/api/v1/visits", "/api/v1/visits.csv"}) {
    EXPECT_EQ(ask(path).status, 401) << path;
    EXPECT_EQ(ask(path, viewer_).status, 200) << path;
  }
}

TEST_F(VisitsApi, DaysAreCheckedAndBoundTheList) {
  ASSERT_EQ(report("?seconds=1&level=0"), 204);
  EXPECT_EQ(listed("?from=1970-01-01&to=9999-12-31").size(), 1u);
  EXPECT_TRUE(listed("?from=2020-02-29&to=2020-02-29").empty());
  for (const char* query :
       {"?from=2021-02-29", "?to=2020-1-01", "?to=1969-12-31", "?from=2020-02-02&to=2020-02-01",
        "?from=9999-01-01", "?to=now", "?day=2020-01-01"})
    EXPECT_EQ(ask(std::string("/api/v1/visits") + query, viewer_).status, 400) << query;
  const json days = json::parse(ask("/api/v1/visits?to=2020-01-30", viewer_).body);
  EXPECT_EQ(days["from"], "2020-01-01");
}

TEST_F(VisitsApi, TheCsvFileHasARowForEachModelAndDayAndNoFormula) {
  ASSERT_EQ(report("?seconds=7&level=0"), 204);
  const HttpAnswer answer = ask("/api/v1/visits.csv", viewer_);
  EXPECT_EQ(answer.field("content-type"), "text/csv; charset=utf-8");
  EXPECT_THAT(answer.field("content-disposition"), HasSubstr(".csv"));
  EXPECT_THAT(answer.body, HasSubstr("day,model,title,visits,seconds,mean_level,complete\r\n20"));
  EXPECT_THAT(answer.body,
              HasSubstr("," + id_.to_string() + ",\"'=A \"\"bust\"\", old\",1,7,0.00,0\r\n"));
}

}  // namespace
}  // namespace vitrine::server
