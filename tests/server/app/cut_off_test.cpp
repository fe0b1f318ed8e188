// SPDX-License-Identifier: Apache-2.0
// Tests connections that take too long, and clients that open more connections than the daemon
// accepts.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <memory>
#include <optional>
#include <vector>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

class CutOffTest : public ::testing::Test {
 protected:
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon{folder.path(), {"--idle-timeout", "1"}};
};

TEST_F(CutOffTest, AConnectionThatSaysNothing) {
  EXPECT_TRUE(HttpClient(daemon.port()).is_closed());
}

TEST_F(CutOffTest, AConnectionThatSaysNothingMore) {
  HttpClient client(daemon.port());
  EXPECT_EQ(client.get("/api/v1/models/" + id).status, 200);
  EXPECT_TRUE(client.is_closed());
}

TEST_F(CutOffTest, AHeaderThatDoesNotEnd) {
  HttpClient client(daemon.port());
  client.send("GET / HTTP/1.1\r\nHost: a\r\nX-Slow: ");
  EXPECT_TRUE(client.is_closed());
}

TEST_F(CutOffTest, ABodyThatNobodyTakes) {
  HttpClient client(daemon.port());
  client.send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 10\r\n\r\nhalf");
  EXPECT_EQ(client.receive().status, 405);
  EXPECT_TRUE(client.is_closed());
}

TEST_F(CutOffTest, AnAnswerThatNobodyTakes) {
  HttpClient client(daemon.port());
  std::string requests;  // the responses are far larger than the sockets' buffers
  for (int i = 0; i < 2000; ++i) {
    requests += "GET /api/v1/models/" + id + "/file.pmesh HTTP/1.1\r\nHost: a\r\n\r\n";
  }
  client.send(requests);
  EXPECT_TRUE(client.is_reset());
}

TEST_F(CutOffTest, AWebSocketWhosePeerDoesNotAnswerPings) {
  WebSocketClient client(daemon.port(), "/api/v1/models/" + id + "/stream", "pmesh.v1");
  EXPECT_EQ(client.receive().kind, WebSocketFrame::kText);
  EXPECT_EQ(client.receive().kind, WebSocketFrame::kPing);
  EXPECT_THROW(while (true) client.receive(), std::runtime_error);
}

// Lowers this process's limit of open files. A daemon that is started before the destructor runs
// inherits the limit.
class FewDescriptors {
 public:
  FewDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit few{64, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST(Descriptors, ALowLimitIsRaisedForTheConnections) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  std::optional<FewDescriptors> few(std::in_place);
  const Daemon daemon(folder.path());
  few.reset();
  std::vector<std::unique_ptr<HttpClient>> held;
  for (int i = 0; i < 100; ++i) {
    held.push_back(std::make_unique<HttpClient>(daemon.port()));
    EXPECT_EQ(held.back()->get("/api/v1/models/" + id).status, 200);
  }
}

TEST(Connections, BeyondTheLimitAreToldSoClosedAndCounted) {
  ServedFolder folder;
  const Daemon daemon(folder.path(), {"--max-connections", "1"});
  HttpClient first(daemon.port());
  EXPECT_EQ(first.get("/nothing").status, 404);
  HttpClient second(daemon.port());
  const HttpAnswer refused = second.receive();
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.field("retry-after"), "5");
  EXPECT_TRUE(second.is_closed());
  EXPECT_NE(
      http_get(daemon.admin_port(), "/metrics").body.find("vitrine_connections_refused_total 1\n"),
      std::string::npos);
}

}  // namespace
}  // namespace vitrine::test
