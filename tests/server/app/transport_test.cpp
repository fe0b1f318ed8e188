// SPDX-License-Identifier: Apache-2.0
// Tests the daemon over TLS, over a Unix socket, and behind proxies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "support/process/certificate.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/process/tls_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class TlsTest : public ::testing::Test {
 protected:
  TlsTest() { write_certificate(make_certificate("A museum"), certificate, key); }

  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  const std::filesystem::path certificate = folder.path() / "chain.pem";
  const std::filesystem::path key = folder.path() / "key.pem";
  const std::vector<std::string> options = {"--tls-certificate", certificate.string(), "--tls-key",
                                            key.string()};
};

TEST_F(TlsTest, ServesFilesAndStreamsOverBothVersions) {
  Daemon daemon(folder.path(), options);
  for (const int minor : {2, 3}) {
    TlsClient client(daemon.port(), minor);
    for (int i = 0; i < 3; ++i) {
      const HttpAnswer file = client.get("/api/v1/models/" + id + "/file.pmesh");
      EXPECT_EQ(file.body, file_bytes(0, served_pmesh().bytes.size()));
      EXPECT_EQ(file.field("strict-transport-security"), "max-age=31536000");
    }
    EXPECT_EQ(client.get("/api/v1/models/" + id).status, 200);
  }
  {
    WebSocketClient stream(std::make_unique<TlsClient>(daemon.port()),
                           "/api/v1/models/" + id + "/stream", "pmesh.v1");
    EXPECT_EQ(stream.receive().kind, WebSocketFrame::kText);
  }
  daemon.signal(SIGTERM);
  const ProgramResult result = daemon.wait();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("listening on https://127.0.0.1:"));
  EXPECT_THAT(result.output, Not(HasSubstr("event=error")));
}

TEST_F(TlsTest, EndsWithAGoodbyeSoThatNothingSeemsCutOff) {
  const Daemon daemon(folder.path(), options);
  TlsClient client(daemon.port());
  EXPECT_EQ(client.get("/nothing", "Connection: close\r\n").status, 404);
  EXPECT_TRUE(client.is_closed());
  EXPECT_TRUE(client.was_told_goodbye());
}

TEST_F(TlsTest, TakesNeitherPlainTextNorOldVersions) {
  const Daemon daemon(folder.path(), options);
  EXPECT_THROW(TlsClient(daemon.port(), 1), std::runtime_error);
  EXPECT_THROW(http_get(daemon.port(), "/"), std::runtime_error);
}

TEST_F(TlsTest, ANewCertificateIsShownToThoseWhoComeThenAndNobodyIsCutOff) {
  const Daemon daemon(folder.path(), options);
  TlsClient before(daemon.port());
  EXPECT_EQ(before.organisation(), "A museum");
  write_certificate(make_certificate("Another museum"), certificate, key);
  while (TlsClient(daemon.port()).organisation() != "Another museum") {
  }
  EXPECT_EQ(before.get("/api/v1/models/" + id).status, 200);
}

TEST_F(TlsTest, RefusesToStartWithoutBothFilesOrWithThoseThatDoNotFit) {
  const std::string data = folder.path().string();
  const Daemon other(folder.path(), {});
  const std::string in_use = "127.0.0.1:" + std::to_string(other.port());
  ProgramResult result =
      run_vitrined({"--data", data, "--listen", in_use, "--tls-key", key.string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("tls-key is set alone; set tls-certificate, too"));
  write_certificate({make_certificate("A").certificate, make_certificate("B").key}, certificate,
                    key);
  for (const char* action : {"--check-config", "--threads=1"}) {
    std::vector<std::string> arguments = {"--data", data, "--listen", in_use, action};
    arguments.insert(arguments.end(), options.begin(), options.end());
    result = run_vitrined(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.output, HasSubstr("it is not the key of"));
  }
}

TEST(UnixSocket, ServesWhoConnectsAndIsGoneAtTheEnd) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  const std::filesystem::path path = folder.path() / "vitrine.sock";
  const std::vector<std::string> options = {"--listen", "unix:" + path.string()};
  { Daemon killed(folder.path(), options); }
  EXPECT_TRUE(std::filesystem::exists(path)) << "what is left over is replaced";
  Daemon daemon(folder.path(), options);
  HttpClient client(path);
  EXPECT_EQ(client.get("/api/v1/models/" + id + "/file.pmesh").body,
            file_bytes(0, served_pmesh().bytes.size()));
  const ProgramResult second = run_vitrined(
      {"--data", folder.path().string(), options[0], options[1], "--admin-listen", "127.0.0.1:0"});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.output, HasSubstr("Address already in use"));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THAT(daemon.access_log(), HasSubstr(" remote=unix "));
}

TEST(Proxies, AreBelievedWhereTheyAreTrusted) {
  ServedFolder folder;
  for (const bool trusted : {true, false}) {
    Daemon daemon(folder.path(), {"--trusted-proxies", trusted ? "127.0.0.1" : "10.0.0.0/8"});
    http_get(daemon.port(), "/nothing", "X-Forwarded-For: 192.0.2.7\r\n");
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait().exit_code, 0);
    EXPECT_THAT(daemon.access_log(), HasSubstr(trusted ? "remote=192.0.2.7 " : "127.0.0.1 "));
    EXPECT_EQ(daemon.access_log().find("192.0.2.7") != std::string::npos, trusted);
    std::filesystem::remove(folder.path() / "access.log");
  }
}

TEST(ShortAddresses, StandInAllLogs) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon(folder.path(), {"--log-addresses", "short", "--trusted-proxies", "127.0.0.1"});
  const std::string client = "X-Forwarded-For: 192.0.2.7\r\n";
  http_get(daemon.port(), "/api/v1/models/" + id, client);
  http_get(daemon.port(), "/nothing", client);
  http_get(daemon.port(), "/api/v1/uploads", client, "DELETE");
  http_get(daemon.port(), "/api/v1/models/" + id, client, "DELETE");
  {
    WebSocketClient stream(daemon.port(), "/api/v1/models/" + id + "/stream?head=true", "pmesh.v1",
                           client);
    stream.receive();
    http_get(daemon.port(), "/nothing");  // a request by the proxy itself
  }
  daemon.signal(SIGTERM);
  const ProgramResult result = daemon.wait();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("event=audit"));
  EXPECT_THAT(daemon.access_log(), HasSubstr("/stream"));
  for (const std::string& text : {result.output, daemon.access_log()}) {
    EXPECT_THAT(text, HasSubstr(" remote=192.0.2.0/24 "));
    EXPECT_THAT(text, Not(HasSubstr("192.0.2.7")));
    EXPECT_THAT(text, Not(HasSubstr("remote=127.0.0.1")));
  }
  EXPECT_THAT(daemon.access_log(), HasSubstr(" remote=127.0.0.0/24 "));
}

std::string from(const std::string& address) {
  return "X-Forwarded-For: " + address + "\r\n";
}

TEST(Limits, WhoAsksTooOftenIsToldWhenToComeBackAndOthersAreServed) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  const Daemon daemon(folder.path(), {"--request-rate", "1", "--trusted-proxies", "127.0.0.1"});
  HttpClient client(daemon.port());
  HttpAnswer answer;
  while (answer.status != 429)
    answer = client.get("/api/v1/models/" + id, "X-Forwarded-For: 192.0.2.7\r\n");
  EXPECT_EQ(answer.field("retry-after"), "1");
  EXPECT_EQ(client.get("/api/v1/openapi.json", from("192.0.2.7")).status, 200)
      << "it comes from memory";
  // On a slow machine, the rate limit may by now allow the address another request. The test
  // therefore tries several times.
  bool is_refused = false;
  for (int i = 0; i < 10 && !is_refused; ++i)
    is_refused = client.get("/nothing", from("192.0.2.7")).status == 429;
  EXPECT_TRUE(is_refused);
  EXPECT_EQ(client.get("/api/v1/models/" + id, "X-Forwarded-For: 192.0.2.8\r\n").status, 200);
}

TEST(Limits, AnAddressHasNoMoreConnectionsThanItsShareUnlessItIsAProxys) {
  ServedFolder folder;
  for (const std::string proxy : {"10.0.0.1", "127.0.0.1"}) {
    const Daemon daemon(folder.path(),
                        {"--max-connections-per-address", "1", "--trusted-proxies", proxy});
    HttpClient first(daemon.port());
    EXPECT_EQ(first.get("/nothing").status, 404);
    HttpClient second(daemon.port());
    if (proxy == "127.0.0.1") {
      EXPECT_EQ(second.get("/nothing").status, 404);
    } else {
      EXPECT_EQ(second.receive().status, 429);
    }
  }
}

TEST(Limits, OneAddressHasATenthOfAllConnectionsByDefault) {
  ServedFolder folder;
  const Daemon daemon(folder.path(), {"--max-connections", "20"});
  HttpClient first(daemon.port()), second(daemon.port());
  EXPECT_EQ(first.get("/nothing").status, 404);
  EXPECT_EQ(second.get("/nothing").status, 404);
  HttpClient third(daemon.port());
  EXPECT_EQ(third.receive().status, 429);
}

TEST(Limits, ATokenHasOneBudgetWhereverItIsUsed) {
  ServedFolder folder;
  const std::string model = "/api/v1/models/" + folder.publish("A small bust");
  const auto bearer = [&] {
    return "Authorization: Bearer " + folder.token(Role::kViewer) + "\r\n";
  };
  const std::string token = bearer(), other = bearer();
  const Daemon daemon(folder.path(), {"--request-rate", "1", "--trusted-proxies", "127.0.0.1"});
  HttpClient client(daemon.port());
  HttpAnswer answer;
  for (int i = 0; i < 200 && answer.status != 429; ++i)  // each request has another client address
    answer = client.get(model, token + from("192.0.2." + std::to_string(i)));
  EXPECT_EQ(answer.status, 429);
  EXPECT_EQ(client.get(model, other + from("192.0.2.0")).status, 200);
}

TEST(Limits, AllOfAnIpv6NetworkShareOnesBudget) {
  ServedFolder folder;
  const std::string model = "/api/v1/models/" + folder.publish("A small bust");
  const Daemon daemon(folder.path(), {"--request-rate", "1", "--trusted-proxies", "127.0.0.1"});
  HttpClient client(daemon.port());
  int answered = 0;
  while (client.get(model, from("2001:db8::" + std::to_string(answered))).status == 200)
    ++answered;
  EXPECT_GE(answered, 10);
  EXPECT_EQ(client.get(model, from("2001:db8:0:1::")).status, 200);
}

// The test sends at most five HTTP requests, fewer than the limit. The daemon can refuse one of
// them only if the messages on the stream count towards the same limit.
TEST(Limits, ModelsThatAreOpenedOnAStreamAreOfItsNetworksBudget) {
  ServedFolder folder;
  const std::string model = "/api/v1/models/" + folder.publish("A small bust");
  const Daemon daemon(folder.path(), {"--request-rate", "1", "--trusted-proxies", "127.0.0.1"});
  WebSocketClient stream(daemon.port(), model + "/stream", "pmesh.v1", from("2001:db8::1"));
  stream.receive();
  for (int i = 0; i < 5; ++i) {
    std::string answer;
    while (answer.find("too many") == std::string::npos) {
      stream.send_text(R"({"type":"open","model":1,"id":"none"})");
      answer = stream.receive().payload;
    }
    if (http_get(daemon.port(), model, from("2001:db8::2")).status == 429) return;
  }
  FAIL() << "another address of the network has a budget of its own";
}

TEST(Limits, AStreamBehindAProxyCountsForItsVisitor) {
  ServedFolder folder;
  const std::string stream = "/api/v1/models/" + folder.publish("A small bust") + "/stream";
  const Daemon daemon(folder.path(),
                      {"--max-connections-per-address", "1", "--trusted-proxies", "127.0.0.1"});
  const auto open = [&](const std::string& visitor) {
    return std::make_unique<WebSocketClient>(daemon.port(), stream, "pmesh.v1", from(visitor));
  };
  auto first = open("2001:db8::1");
  EXPECT_THROW(open("2001:db8::2"), std::runtime_error);
  EXPECT_NO_THROW(open("2001:db8:0:1::1"));
  first->receive();
  first->send_close();
  while (first->receive().kind != WebSocketFrame::kClose) {
  }
  EXPECT_TRUE(first->is_closed());
  first.reset();
  // Retries until the daemon has noticed that the first connection has ended.
  for (bool is_in = false; !is_in;) {
    try {
      open("2001:db8::3");
      is_in = true;
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace
}  // namespace vitrine::test
