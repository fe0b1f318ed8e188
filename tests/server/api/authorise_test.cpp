// SPDX-License-Identifier: Apache-2.0
#include "server/http/authorise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/auth/role.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using test::LocalServer;
using ::testing::HasSubstr;
using ::testing::Not;

Response tell_caller(const Request& request, Services&) {
  Response response;
  response.type = "text/plain";
  response.body = request.caller ? request.caller->token.to_string() + " " +
                                       std::string(name_of(request.caller->role))
                                 : std::string("nobody");
  return response;
}

constexpr ApiRoute kGuardedRoutes[] = {
    {.method = Method::kGet,
     .path = "/none",
     .handler = tell_caller,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/viewer",
     .handler = tell_caller,
     .executor = Executor::kWorker,
     .role = Role::kViewer},
    {.method = Method::kGet,
     .path = "/operator",
     .handler = tell_caller,
     .executor = Executor::kInline,
     .role = Role::kOperator},
    {.method = Method::kPost,
     .path = "/operator/{name}",
     .handler = tell_caller,
     .executor = Executor::kWorker,
     .role = Role::kOperator},
    {.method = Method::kDelete,
     .path = "/admin",
     .handler = tell_caller,
     .executor = Executor::kWorker,
     .role = Role::kAdmin},
};

class AuthoriseTest : public ::testing::Test {
 protected:
  HttpAnswer get(const std::string& path, const std::string& fields = "") const {
    return test::http_get(server_.port(), path, fields);
  }
  LocalServer server_{kGuardedRoutes};
};

TEST_F(AuthoriseTest, EachRoleMayWhatItIsMeantToAndNoMore) {
  const std::string fields[] = {"", server_.bearer(Role::kViewer), server_.bearer(Role::kOperator),
                                server_.bearer(Role::kAdmin)};
  const std::pair<std::string, std::string> calls[] = {
      {"GET", "/none"}, {"GET", "/viewer"}, {"POST", "/operator/a"}, {"DELETE", "/admin"}};
  for (int needed = 0; needed < 4; ++needed) {
    for (int has = 0; has < 4; ++has) {
      const int wanted = has >= needed ? 200 : has == 0 ? 401 : 403;
      const auto& [method, path] = calls[needed];
      EXPECT_EQ(test::http_get(server_.port(), path, fields[has], method).status, wanted)
          << path << " as " << has;
    }
  }
  EXPECT_EQ(get("/operator", fields[1]).status, 403) << "inline too";
  EXPECT_EQ(get("/operator", fields[2]).status, 200);
}

TEST_F(AuthoriseTest, TheHandlerLearnsWhoCalls) {
  const NewToken token = create_token(server_.catalogue(), Role::kViewer, "").value();
  const std::string field = "Authorization: bearer " + token.text + "\r\n";
  EXPECT_EQ(get("/viewer", field).body, token.id.to_string() + " viewer");
  EXPECT_EQ(get("/none", field).body, token.id.to_string() + " viewer");
  EXPECT_EQ(get("/none").body, "nobody");
}

TEST_F(AuthoriseTest, ARefusalSaysWhatIsMissing) {
  const HttpAnswer none = get("/viewer");
  EXPECT_EQ(none.field("www-authenticate"), "Bearer");
  EXPECT_EQ(none.field("content-type"), "application/problem+json");
  EXPECT_EQ(none.field("cache-control"), "no-store");
  const HttpAnswer unknown =
      get("/viewer", "Authorization: Bearer vtr_" + std::string(43, 'A') + "\r\n");
  EXPECT_EQ(unknown.status, 401);
  EXPECT_EQ(unknown.field("www-authenticate"), "Bearer error=\"invalid_token\"");
  const HttpAnswer low = get("/operator", server_.bearer(Role::kViewer));
  EXPECT_EQ(low.status, 403);
  EXPECT_THAT(low.body, HasSubstr("role operator"));
}

TEST_F(AuthoriseTest, WhatIsNoBearerTokenIsNobodys) {
  const std::string good = server_.bearer(Role::kAdmin);
  const std::string text = good.substr(22, 47);
  for (const std::string& field :
       {"Authorization: Basic " + text + "\r\n", "Authorization: " + text + "\r\n", good + good,
        std::string("Authorization: Bearer\r\n"), "Authorization: Bearer " + text + "A\r\n",
        "Authorization: Bearer  " + text + "\r\n", "Authorization: Bearer x" + text + "\r\n"}) {
    EXPECT_EQ(get("/viewer", field).status, 401) << field;
  }
  EXPECT_EQ(get("/viewer?access_token=" + text).status, 401) << "not in a URL, which is logged";
}

TEST_F(AuthoriseTest, ARevokedTokenIsWorthlessAtOnce) {
  const NewToken token = create_token(server_.catalogue(), Role::kAdmin, "").value();
  const std::string field = "Authorization: Bearer " + token.text + "\r\n";
  EXPECT_EQ(get("/viewer", field).status, 200);
  ASSERT_TRUE(server_.catalogue().revoke_token(token.id));
  server_.services().tokens.forget();  // the route that revokes a token also empties this cache
  EXPECT_EQ(get("/viewer", field).status, 401);
  EXPECT_EQ(get("/none", field).status, 401) << "a caller with a wrong token gets an error";
}

TEST_F(AuthoriseTest, WhoGuessesIsToldToWaitAndWhoseTokenIsGoodIsNot) {
  const std::string wrong = "Authorization: Bearer guess\r\n";
  for (std::uint32_t i = 0; i < Throttle::kFailures; ++i)
    EXPECT_EQ(get("/viewer", wrong).status, 401);
  const HttpAnswer answer = get("/viewer", wrong);
  EXPECT_EQ(answer.status, 429);
  EXPECT_GT(std::stoi(answer.field("retry-after")), 0);
  EXPECT_EQ(server_.metrics().unknown_tokens.load(), Throttle::kFailures + 1);
  EXPECT_EQ(get("/viewer", server_.bearer(Role::kViewer)).status, 200);
  EXPECT_EQ(get("/viewer").status, 401) << "no token is no guess";
}

TEST_F(AuthoriseTest, EveryCallThatIsToChangeSomethingIsAudited) {
  const NewToken token = create_token(server_.catalogue(), Role::kOperator, "").value();
  const std::string field = "Authorization: Bearer " + token.text + "\r\n";
  test::HttpClient client(server_.port());
  const HttpAnswer done = client.get("/operator/rig-1", field, "POST");
  const HttpAnswer low = client.get("/admin", field, "DELETE");
  const HttpAnswer nobody = client.get("/admin", "", "DELETE");
  client.get("/viewer", field);  // once this request is answered, all earlier ones are logged
  client.get("/viewer", field);
  const std::string id = token.id.to_string(), log = server_.events();
  EXPECT_THAT(log, HasSubstr("event=audit id=" + done.field("x-request-id") +
                             " remote=127.0.0.1 token=" + id +
                             " method=POST route=/operator/{name} target=/operator/rig-1 "
                             "status=200\n"));
  EXPECT_THAT(log, HasSubstr(low.field("x-request-id") + " remote=127.0.0.1 token=" + id +
                             " method=DELETE route=/admin target=/admin status=403\n"));
  EXPECT_THAT(log, HasSubstr(nobody.field("x-request-id") + " remote=127.0.0.1 token=- "));
  EXPECT_THAT(log, Not(HasSubstr("route=/viewer")));
  EXPECT_THAT(log, Not(HasSubstr(token.text.substr(4))));
}

}  // namespace
}  // namespace vitrine::server
