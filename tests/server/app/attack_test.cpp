// SPDX-License-Identifier: Apache-2.0
// Tests attacks on the daemon. The daemon must answer or cut off each attacker, serve other clients
// meanwhile, and log no errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <csignal>
#include <memory>
#include <vector>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/resident_memory.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Waits for 20 ms, as a slow client does between two bytes.
void pause() {
  ::poll(nullptr, 0, 20);
}

class AttackTest : public ::testing::Test {
 protected:
  explicit AttackTest(std::vector<std::string> options = {"--idle-timeout", "1"})
      : daemon(folder.path(), std::move(options)) {}

  void TearDown() override {
    EXPECT_EQ(http_get(daemon.port(), "/api/v1/models/" + id).status, 200);
    daemon.signal(SIGTERM);
    const ProgramResult result = daemon.wait();
    EXPECT_EQ(result.exit_code, 0);
  }
  std::string bearer(Role role) { return "Authorization: Bearer " + folder.token(role) + "\r\n"; }

  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon;
};

TEST_F(AttackTest, AHeaderThatComesAByteAtATimeIsCutOff) {
  HttpClient client(daemon.port());
  client.send("GET / HTTP/1.1\r\nHost: a\r\nX: ");
  EXPECT_THROW(
      for (int i = 0; i < 1000; ++i) {
        client.send("x");
        pause();
      },
      std::runtime_error);
}

TEST_F(AttackTest, ABodyThatComesAByteAtATimeIsAnsweredAndCutOff) {
  HttpClient client(daemon.port());
  client.send("POST /api/v1/models/" + id + "/publish HTTP/1.1\r\nHost: a\r\n" +
              bearer(Role::kOperator) + "Content-Length: 10000\r\n\r\n");
  EXPECT_THROW(
      for (int i = 0; i < 1000; ++i) {
        client.send("x");
        pause();
      },
      std::runtime_error);
  EXPECT_EQ(client.receive().status, 408);
}

// A model far larger than the buffers of two sockets.
const TinyPmesh& large_pmesh() {
  static const TinyPmesh pmesh = tiny_pmesh("a base mesh", std::string(32'000'000, 'c'));
  return pmesh;
}

class SlowReaderTest : public AttackTest {
 protected:
  SlowReaderTest() : AttackTest({"--idle-timeout", "1", "--min-rate", "100000000"}) {}
};

TEST_F(SlowReaderTest, WhoTakesAnAnswerTooSlowlyIsCutOff) {
  const std::string large = folder.publish("A large bust", large_pmesh());
  HttpClient client(daemon.port());
  client.send("GET /api/v1/models/" + large + "/file.pmesh HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_THROW(
      for (int i = 0; i < 300; ++i) {
        client.read_exactly(100'000);  // the pauses between reads are shorter than the idle timeout
        pause();
      },
      std::runtime_error);
}

// A client that reads one byte at a time from a socket with a small receive buffer.
class DrippingClient final : public HttpClient {
 public:
  explicit DrippingClient(std::uint16_t port) : HttpClient(port) {
    constexpr int kLittle = 4096;
    ::setsockopt(socket(), SOL_SOCKET, SO_RCVBUF, &kLittle, sizeof kLittle);
  }

 private:
  ssize_t read_some(char* bytes, std::size_t) override { return ::recv(socket(), bytes, 1, 0); }
};

TEST_F(AttackTest, WhoTakesAStreamAByteAtATimeCostsLittleAndIsCutOff) {
  const std::string large = folder.publish("A large bust", large_pmesh());
  const auto streams = [&] { return http_get(daemon.admin_port(), "/metrics").body; };
  auto http = std::make_unique<DrippingClient>(daemon.port());
  DrippingClient& raw = *http;
  WebSocketClient client(std::move(http), "/api/v1/models/" + large + "/stream", "pmesh.v1");
  client.receive();
  EXPECT_THAT(streams(), HasSubstr("\nvitrine_streams 1\n"));
  [[maybe_unused]] const std::size_t before = resident_bytes(daemon.pid());
  client.send_text(R"({"type":"ack","bytes":16777216})");
  client.send_text(R"({"type":"want","level":1})");
  std::string text;
  for (int i = 0; i < 500 && text.find("\nvitrine_streams 0\n") == std::string::npos; ++i) {
    try {
      raw.read_exactly(1);
    } catch (const std::runtime_error&) {  // the daemon has cut off the connection
    }
    pause();
    text = streams();
  }
  EXPECT_THAT(text, HasSubstr("\nvitrine_streams 0\n"));
#ifndef VITRINE_SANITISED
  EXPECT_LT(resident_bytes(daemon.pid(), "VmHWM:"), before + (4 << 20));
#endif
}

TEST_F(AttackTest, HalfOpenConnectionsCostLittleAndGo) {
  constexpr std::size_t kConnections = 400;
#ifdef VITRINE_SANITISED
  constexpr std::size_t kBytesEach = 100'000;  // the sanitizer needs more memory per connection
#else
  constexpr std::size_t kBytesEach = 20'000;
#endif
  http_get(daemon.port(), "/api/v1/models/" + id);
  const std::size_t before = resident_bytes(daemon.pid());
  std::vector<std::unique_ptr<HttpClient>> held;
  for (std::size_t i = 0; i < kConnections; ++i) {
    held.push_back(std::make_unique<HttpClient>(daemon.port()));
    held.back()->send("GET / HTTP/1.1\r\nHost:");
  }
  EXPECT_EQ(http_get(daemon.port(), "/api/v1/models/" + id).status, 200);
  EXPECT_LT(resident_bytes(daemon.pid()), before + kConnections * kBytesEach);
  for (const auto& client : held)
    EXPECT_TRUE(client->is_closed());
}

TEST_F(AttackTest, NoPathLeadsOutOfWhatIsServed) {
  for (const char* target : {"/../../etc/passwd",
                             "/%2e%2e/%2e%2e/etc/passwd",
                             "/..%2f..%2fetc%2fpasswd",
                             "/....//....//etc/passwd",
                             "/..\\..\\etc\\passwd",
                             "/..%5c..%5cetc%5cpasswd",
                             "/%c0%ae%c0%ae/etc/passwd",
                             "/%252e%252e/etc/passwd",
                             "//etc/passwd",
                             "/./../etc/passwd",
                             "/index.html/../../etc/passwd",
                             "/index.html%00.png",
                             "/etc/passwd",
                             "/;/../etc/passwd",
                             "/api/v1/models/../../../etc/passwd",
                             "/api/v1/models/..%2f..%2fcatalogue.db",
                             "/api/v1/chunks/../../catalogue.db",
                             "/api/v1/chunks/%2e%2e%2f%2e%2e%2fcatalogue.db",
                             "/objects/../catalogue.db",
                             "http://a/../../etc/passwd",
                             "/~root",
                             "/.git/config"}) {
    const HttpAnswer answer = http_get(daemon.port(), target);
    EXPECT_THAT(answer.status, AnyOf(400, 404)) << target;
    EXPECT_THAT(answer.body, Not(HasSubstr("root:"))) << target;
  }
}

TEST_F(AttackTest, WhatIsTooLargeIsRefusedForWhatItIs) {
  const auto status = [&](const std::string& request) {
    HttpClient client(daemon.port());
    client.send(request);
    return client.receive().status;
  };
  const std::string host = " HTTP/1.1\r\nHost: a\r\n";
  EXPECT_EQ(status("GET /" + std::string(9'000, 'x') + host + "\r\n"), 414);
  EXPECT_EQ(status("GET /" + host + "X: " + std::string(17'000, 'x') + "\r\n\r\n"), 431);
  std::string many;
  for (int i = 0; i < 2'000; ++i)
    many += "X: a\r\n";
  EXPECT_EQ(status("GET /" + host + many + many + "\r\n"), 431);
  const std::string post =
      "POST /api/v1/models/" + id + "/publish" + host + bearer(Role::kOperator);
  EXPECT_EQ(status(post + "Content-Length: 100000000000\r\n\r\n"), 413);
  EXPECT_EQ(status(post + "Transfer-Encoding: chunked\r\n\r\nfffffff\r\n"), 413);
  EXPECT_THAT(status(post + "Transfer-Encoding: chunked\r\n\r\n1;" + std::string(70'000, 'x')),
              AnyOf(400, 413, 431));
}

TEST_F(AttackTest, GuessingTokensIsSlowedDownWhileTheirOwnersGetOn) {
  const std::string own = bearer(Role::kOperator);
  HttpClient client(daemon.port());
  HttpAnswer answer;
  for (int i = 0; i < 11; ++i) {
    const std::string digits = std::to_string(10 + i);
    answer = client.get("/api/v1/jobs",
                        "Authorization: Bearer vtr_" + std::string(41, 'A') + digits + "\r\n");
    EXPECT_THAT(answer.status, i < 10 ? 401 : 429);
  }
  EXPECT_EQ(answer.status, 429);
  EXPECT_NE(answer.field("retry-after"), "");
  EXPECT_EQ(client.get("/api/v1/jobs", own).status, 200);
}

// Requests for unknown paths cost the attacker little, and the daemon answers them from memory.
// Their log lines must stay short.
TEST_F(AttackTest, PipelinedUnknownPathsFillNoLog) {
  constexpr int kRequests = 2'000;
  constexpr std::size_t kTarget = 4'000;
  const std::string request =
      "GET /" + std::string(kTarget, '\xe9') + " HTTP/1.1\r\nHost: a\r\n\r\n";
  HttpClient client(daemon.port());
  for (int i = 0; i < kRequests; ++i) {
    client.send(request);
    EXPECT_EQ(client.receive().status, 404);
  }
  EXPECT_LT(daemon.access_log().size(), kRequests * 550u);
}

}  // namespace
}  // namespace vitrine::test
