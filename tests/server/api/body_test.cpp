// SPDX-License-Identifier: Apache-2.0
// Tests request bodies over a real connection: size limits, deadlines, and where the server expects
// the next request.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/http/upgrade.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using test::HttpClient;
using test::LocalServer;

Response echo(const Request& request, Services&) {
  Response response;
  response.type = "application/json";
  response.body = request.body.dump();
  return response;
}
class NoProtocol : public Upgrade {
 public:
  asio::awaitable<void> serve(UpgradedConnection, HttpServer&) override { co_return; }
};
Response upgrade(const Request&, Services&) {
  Response response;
  response.status = 101;
  response.upgrade = std::make_shared<NoProtocol>();
  return response;
}

constexpr ApiRoute kBodyRoutes[] = {
    {.method = Method::kPost, .path = "/echo", .handler = echo, .executor = Executor::kWorker},
    {.method = Method::kPost,
     .path = "/private",
     .handler = echo,
     .executor = Executor::kWorker,
     .role = Role::kOperator},
    {.method = Method::kGet, .path = "/read", .handler = echo, .executor = Executor::kInline},
    {.method = Method::kGet, .path = "/upgrade", .handler = upgrade, .executor = Executor::kInline},
};
const std::string kJson = "Content-Type: application/json\r\n";
const std::string kHidden = "GET /read?hidden HTTP/1.1\r\nHost: a\r\n\r\n";

std::string message(const std::string& start, const std::string& fields, const std::string& body) {
  return start + " HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n" + body;
}
std::string post(const std::string& path, const std::string& body,
                 const std::string& fields = kJson) {
  return message("POST " + path, fields + "Content-Length: " + std::to_string(body.size()) + "\r\n",
                 body);
}
std::string chunked(const std::string& chunks) {
  return message("POST /echo", kJson + "Transfer-Encoding: chunked\r\n", chunks);
}

class BodyTest : public ::testing::Test {
 protected:
  LocalServer server_{kBodyRoutes};
};

TEST_F(BodyTest, ReachesTheHandlerHoweverItIsFramed) {
  HttpClient client(server_.port());
  client.send(post("/echo", R"({"a":1})") + chunked("3;x=y\r\n{\"b\r\n4\r\n\":2}\r\n0\r\n\r\n") +
              post("/echo", "", ""));
  EXPECT_EQ(client.receive().body, R"({"a":1})");
  EXPECT_EQ(client.receive().body, R"({"b":2})");
  EXPECT_EQ(client.receive().body, "{}");
}

TEST_F(BodyTest, WhatIsNoJsonObjectCostsItsRequestAlone) {
  HttpClient client(server_.port());
  client.send(post("/echo", "{") + post("/echo", "{}", "Content-Type: text/plain\r\n") +
              post("/echo", R"({"a":1})"));
  EXPECT_EQ(client.receive().status, 400);
  EXPECT_EQ(client.receive().status, 415);
  EXPECT_EQ(client.receive().body, R"({"a":1})");
}

TEST_F(BodyTest, WhatIsTooLargeOrMalformedEndsTheConnection) {
  const std::string large(70'000, ' ');
  const std::pair<std::string, int> cases[] = {
      {post("/echo", large), 413},
      {chunked("10000\r\n" + large.substr(0, 65'536) + "\r\n1\r\n \r\n0\r\n\r\n"), 413},
      {chunked("fffffffffffffffff\r\n"), 400},
      {chunked("-1\r\n"), 400},
      {chunked("2\r\n{}x\r\n"), 400},
      {chunked("1;" + std::string(100'000, 'x')), 400}};
  for (const auto& [request, status] : cases) {
    HttpClient client(server_.port());
    client.send(request + kHidden);
    EXPECT_EQ(client.receive().status, status) << request.substr(0, 90);
    EXPECT_TRUE(client.is_closed()) << request.substr(0, 90);
  }
}

// The bytes of a body that no handler reads must never be parsed as the next request.
TEST_F(BodyTest, OneThatNobodyTakesEndsTheConnectionUnread) {
  const std::string length = "Content-Length: " + std::to_string(kHidden.size()) + "\r\n";
  const std::pair<std::string, int> cases[] = {
      {post("/private", kHidden), 401},
      {post("/nowhere", kHidden), 404},
      {post("/read", kHidden), 405},
      {message("DELETE /echo", length, kHidden), 405},
      {message("OPTIONS /echo", length, kHidden), 204},
      {message("GET /read", length, kHidden), 200},
      {message("GET /read", "Transfer-Encoding: chunked\r\n", kHidden), 200},
      {message("GET /upgrade", length, kHidden), 400},
      {post("/echo", kHidden, kJson + "Expect: miracles\r\n"), 417}};
  for (const auto& [request, status] : cases) {
    HttpClient client(server_.port());
    client.send(request + kHidden);
    EXPECT_EQ(client.receive().status, status) << request.substr(0, 90);
    EXPECT_TRUE(client.is_closed()) << request.substr(0, 90);
  }
}

TEST_F(BodyTest, IsAskedForWhereTheClientWaitsForThat) {
  HttpClient client(server_.port());
  const std::string head =
      message("POST /echo", kJson + "Expect: 100-continue\r\nContent-Length: 2\r\n", "");
  client.send(head);
  EXPECT_EQ(client.receive().status, 100);
  client.send("{}" + post("/echo", R"({"next":1})"));
  EXPECT_EQ(client.receive().body, "{}");
  EXPECT_EQ(client.receive().body, R"({"next":1})");
  HttpClient stranger(server_.port());
  stranger.send(message("POST /private", "Expect: 100-continue\r\nContent-Length: 2\r\n", ""));
  EXPECT_EQ(stranger.receive().status, 401) << "it need not be sent";
}

TEST(SlowBody, OneThatDoesNotComeInTimeIsAnswered) {
  const LocalServer server(kBodyRoutes, std::chrono::seconds(1));
  HttpClient client(server.port());
  client.send(message("POST /echo", kJson + "Content-Length: 10\r\n", "{\"ha"));
  EXPECT_EQ(client.receive().status, 408);
  EXPECT_TRUE(client.is_closed());
}

}  // namespace
}  // namespace vitrine::server
