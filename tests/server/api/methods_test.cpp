// SPDX-License-Identifier: Apache-2.0
// Tests the methods that a path supports, and the requests that pages of other origins may send.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using test::LocalServer;

Response say(const char* text) {
  Response response;
  response.type = "text/plain";
  response.body = std::string(text);
  return response;
}
Response read(const Request&, Services&) {
  return say("read");
}
Response change(const Request&, Services&) {
  return say("changed");
}

constexpr ApiRoute kMethodRoutes[] = {
    {.method = Method::kGet, .path = "/public", .handler = read, .executor = Executor::kInline},
    {.method = Method::kPost,
     .path = "/public",
     .handler = change,
     .executor = Executor::kWorker,
     .role = Role::kOperator},
    {.method = Method::kGet,
     .path = "/private",
     .handler = read,
     .executor = Executor::kWorker,
     .role = Role::kViewer},
    {.method = Method::kDelete,
     .path = "/private",
     .handler = change,
     .executor = Executor::kWorker,
     .role = Role::kOperator},
    {.method = Method::kPost,
     .path = "/action",
     .handler = change,
     .executor = Executor::kWorker,
     .role = Role::kOperator},
};

class MethodsTest : public ::testing::Test {
 protected:
  HttpAnswer call(const std::string& method, const std::string& path,
                  const std::string& fields = "") const {
    return test::http_get(server_.port(), path, fields, method);
  }
  LocalServer server_{kMethodRoutes};
  const std::string operator_ = server_.bearer(Role::kOperator);
};

TEST_F(MethodsTest, EachMethodReachesItsOwnHandler) {
  EXPECT_EQ(call("GET", "/public").body, "read");
  EXPECT_EQ(call("POST", "/public", operator_ + "Content-Length: 0\r\n").body, "changed");
  EXPECT_EQ(call("DELETE", "/private", operator_).body, "changed");
  EXPECT_EQ(call("HEAD", "/public").field("content-length"), "4");
}

TEST_F(MethodsTest, AnotherMethodIsToldWhatThePathTakes) {
  const struct {
    const char *method, *path, *allow;
  } kCases[] = {{"PUT", "/public", "GET, HEAD, POST, OPTIONS"},
                {"PATCH", "/public", "GET, HEAD, POST, OPTIONS"},
                {"DELETE", "/public", "GET, HEAD, POST, OPTIONS"},
                {"POST", "/private", "GET, HEAD, DELETE, OPTIONS"},
                {"GET", "/action", "POST, OPTIONS"},
                {"HEAD", "/action", "POST, OPTIONS"},
                {"BREW", "/action", "POST, OPTIONS"}};
  for (const auto& test : kCases) {
    const HttpAnswer answer = call(test.method, test.path, operator_);
    EXPECT_EQ(answer.status, 405) << test.method << " " << test.path;
    EXPECT_EQ(answer.field("allow"), test.allow) << test.method << " " << test.path;
  }
}

TEST_F(MethodsTest, PagesOfOtherOriginsMayReadWhatIsPublicAndDoNothingElse) {
  const std::string origin = "Origin: https://other.example\r\n";
  const HttpAnswer open = call("OPTIONS", "/public", origin);
  EXPECT_EQ(open.status, 204);
  EXPECT_EQ(open.field("access-control-allow-origin"), "*");
  EXPECT_EQ(open.field("access-control-allow-methods"), "GET, HEAD, OPTIONS");
  EXPECT_THAT(open.field("access-control-allow-headers"),
              ::testing::Not(::testing::HasSubstr("Authorization")));
  EXPECT_EQ(call("GET", "/public", origin).field("access-control-allow-origin"), "*");
  const HttpAnswer closed[] = {call("OPTIONS", "/private", origin),
                               call("OPTIONS", "/action", origin),
                               call("GET", "/private", origin),
                               call("GET", "/private", origin + operator_),
                               call("POST", "/action", origin + operator_),
                               call("POST", "/public", origin + operator_),
                               call("DELETE", "/private", origin + operator_)};
  for (const HttpAnswer& answer : closed) {
    for (const auto& [name, value] : answer.fields)
      EXPECT_FALSE(name.starts_with("access-control") || name.starts_with("cross-origin")) << name;
  }
  EXPECT_EQ(closed[0].field("allow"), "GET, HEAD, DELETE, OPTIONS");
}

TEST(TrustedOrigin, MaySendTokensAndReadEveryResponse) {
  HttpOptions options;
  options.trusts_origin = [](auto origin) { return origin == "https://museum.example"; };
  LocalServer server(kMethodRoutes, std::chrono::seconds(30), {}, std::move(options));
  const auto call = [&](const std::string& method, const std::string& origin,
                        const std::string& more = "") {
    return test::http_get(server.port(), "/private", "Origin: " + origin + "\r\n" + more, method);
  };
  const std::string wanted = "Access-Control-Request-Headers: authorization,upload-offset\r\n";
  const HttpAnswer preflight = call("OPTIONS", "https://museum.example", wanted);
  EXPECT_EQ(preflight.status, 204);
  EXPECT_EQ(preflight.field("access-control-allow-origin"), "https://museum.example");
  EXPECT_EQ(preflight.field("access-control-allow-headers"), "authorization,upload-offset");
  EXPECT_THAT(preflight.field("access-control-allow-methods"), testing::HasSubstr("DELETE"));
  const std::string who = server.bearer(Role::kOperator);
  const HttpAnswer answer = call("DELETE", "https://museum.example", who);
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.field("access-control-allow-origin"), "https://museum.example");
  EXPECT_EQ(answer.field("vary"), "Origin");
  for (const char* other : {"https://museum.example.evil", "http://museum.example", "null"}) {
    EXPECT_EQ(call("OPTIONS", other, wanted).field("access-control-allow-origin"), "") << other;
    EXPECT_EQ(call("DELETE", other, who).field("access-control-allow-origin"), "") << other;
  }
}

}  // namespace
}  // namespace vitrine::server
