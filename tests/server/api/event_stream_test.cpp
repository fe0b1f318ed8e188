// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_stream.h"

#include <gtest/gtest.h>

#include <deque>
#include <semaphore>

#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using test::HttpClient;
using test::LocalServer;

std::counting_semaphore<8> released{0};  // each source releases it once when it is destroyed

class Source : public EventSource {
 public:
  ~Source() override { released.release(); }
};

// A source of three events. next() returns nullopt before each event except the first. The source
// ends after the third event.
class Countdown final : public Source {
 public:
  std::optional<Event> next() override {
    pause_ = !pause_;
    if (pause_ || left_ == 0) return std::nullopt;
    --left_;
    return Event{.name = "job", .data = std::to_string(left_), .id = "e" + std::to_string(left_)};
  }
  bool ended() const override { return left_ == 0; }

 private:
  int left_ = 3;
  bool pause_ = true;
};

class Silence final : public Source {
 public:
  std::optional<Event> next() override { return std::nullopt; }
  bool ended() const override { return false; }
};

class Flood final : public Source {
 public:
  std::optional<Event> next() override {
    return Event{.name = "job", .data = std::string(8 << 20, 'x'), .id = "1"};
  }
  bool ended() const override { return false; }
};

template <class Kind>
Response events(const Request&, Services&) {
  Response response;
  response.type = "text/event-stream";
  response.events = std::make_shared<Kind>();
  return response;
}

class EventStream : public ::testing::Test {
 protected:
  void SetUp() override {
    while (released.try_acquire()) {  // discards the releases that earlier tests left
    }
  }
};

constexpr ApiRoute kEventRoutes[] = {
    {.method = Method::kGet,
     .path = "/countdown",
     .handler = events<Countdown>,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/silence",
     .handler = events<Silence>,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/flood",
     .handler = events<Flood>,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/secret",
     .handler = events<Silence>,
     .executor = Executor::kWorker,
     .role = Role::kViewer},
};

std::string get(const std::string& path, const std::string& method = "GET") {
  return method + " " + path + " HTTP/1.1\r\nHost: a\r\n\r\n";
}

TEST_F(EventStream, SendsWhatTheSourceGivesAndEndsWithIt) {
  const LocalServer server(kEventRoutes);
  HttpClient client(server.port());
  client.send(get("/countdown"));
  const HttpAnswer head = client.receive();
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.field("content-type"), "text/event-stream");
  EXPECT_EQ(head.field("content-length"), "");
  EXPECT_EQ(head.field("connection"), "close");
  const std::string wanted =
      "event: job\nid: e2\ndata: 2\n\nevent: job\nid: e1\ndata: 1\n\n"
      "event: job\nid: e0\ndata: 0\n\n";
  EXPECT_EQ(client.read_exactly(wanted.size()), wanted);
  EXPECT_TRUE(client.is_closed());
  EXPECT_TRUE(released.try_acquire_for(std::chrono::seconds(20)));
}

TEST_F(EventStream, HeadTellsTheFieldsAlone) {
  const LocalServer server(kEventRoutes);
  HttpClient client(server.port());
  client.send(get("/silence", "HEAD"));
  EXPECT_EQ(client.receive().field("content-type"), "text/event-stream");
  EXPECT_TRUE(client.is_closed());
  EXPECT_TRUE(released.try_acquire_for(std::chrono::seconds(20)));
}

TEST_F(EventStream, APeerThatHasLeftIsNoticedThoughThereIsNothingToSend) {
  const LocalServer server(kEventRoutes);
  {
    HttpClient client(server.port());
    client.send(get("/silence"));
    EXPECT_EQ(client.receive().status, 200);
  }
  EXPECT_TRUE(released.try_acquire_for(std::chrono::seconds(20)));
}

TEST_F(EventStream, APeerThatTakesNothingIsCut) {
  const LocalServer server(kEventRoutes, std::chrono::seconds(1));
  HttpClient client(server.port());
  client.send(get("/flood"));
  EXPECT_TRUE(released.try_acquire_for(std::chrono::seconds(20)));
}

TEST_F(EventStream, ManyShareOneThreadWithOthers) {
  const LocalServer server(kEventRoutes);
  HttpClient first(server.port()), second(server.port());
  for (HttpClient* client : {&first, &second}) {
    client->send(get("/silence"));
    EXPECT_EQ(client->receive().status, 200);
  }
  EXPECT_EQ(test::http_get(server.port(), "/nowhere").status, 404);
}

TEST_F(EventStream, ATokenThatIsRevokedEndsIt) {
  LocalServer server(kEventRoutes);
  HttpClient client(server.port()), other(server.port());
  const auto ask = [&](HttpClient& who) {
    const std::string bearer = server.bearer(Role::kViewer);
    who.send("GET /secret HTTP/1.1\r\nHost: a\r\n" + bearer + "\r\n");
    EXPECT_EQ(who.receive().status, 200);
  };
  ask(client);
  const TokenId token = server.catalogue().tokens().value().at(0).id;
  ask(other);
  ASSERT_TRUE(server.catalogue().revoke_token(token));
  EXPECT_TRUE(client.is_closed());
  server.drain();
  EXPECT_TRUE(other.is_closed());
}

TEST_F(EventStream, BehindAProxyItCountsForItsVisitor) {
  LocalServer server(
      kEventRoutes, std::chrono::seconds(30), {},
      {.max_connections_per_address = 1, .proxies = Networks::parse("127.0.0.1").value()});
  const auto ask = [&](HttpClient& client, const std::string& visitor) {
    client.send("GET /silence HTTP/1.1\r\nHost: a\r\nX-Forwarded-For: " + visitor + "\r\n\r\n");
    return client.receive();
  };
  HttpClient first(server.port()), second(server.port()), of_another(server.port());
  EXPECT_EQ(ask(first, "2001:db8::1").status, 200);
  const HttpAnswer refused = ask(second, "2001:db8::2");
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(refused.field("retry-after"), "5");
  EXPECT_EQ(ask(of_another, "2001:db8:0:1::1").status, 200);
}

TEST_F(EventStream, ADaemonThatStopsEndsIt) {
  LocalServer server(kEventRoutes);
  HttpClient client(server.port());
  client.send(get("/silence"));
  EXPECT_EQ(client.receive().status, 200);
  auto empty = server.drain();
  EXPECT_TRUE(client.is_closed());
  empty.get();
}

}  // namespace
}  // namespace vitrine::server
