// SPDX-License-Identifier: Apache-2.0
// Tests how the real daemon reloads its configuration.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "server/store/quota.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Reload : public ::testing::Test {
 protected:
  Reload() : config((served.path() / "vitrine.conf").string()), id(served.publish("Bust")) {
    write("public-url = https://one.example\n");
    daemon.emplace(served.path(), std::vector<std::string>{"--config", config});
  }

  void write(const std::string& text) const { std::ofstream(config) << text; }

  // Reloads the configuration and returns the log line that states the result.
  std::string reload() {
    daemon->signal(SIGHUP);
    return daemon->wait_for_line("configuration");
  }
  // Returns the origin of the URLs that the daemon writes.
  std::string origin() const {
    const auto answer = http_get(daemon->port(), "/api/v1/iiif/" + id + "/manifest.json");
    const std::string self = nlohmann::json::parse(answer.body)["id"];
    return self.substr(0, self.find("/api"));
  }

  ServedFolder served;
  const std::string config, id;
  std::optional<Daemon> daemon;
};

TEST_F(Reload, TakesANewValueWhileVisitorsStay) {
  HttpClient visitor(daemon->port());
  EXPECT_EQ(visitor.get("/api/v1/models").status, 200);
  EXPECT_EQ(origin(), "https://one.example");
  write("public-url = https://two.example\n");
  EXPECT_THAT(reload(), HasSubstr("configuration read again; new: public-url"));
  EXPECT_EQ(origin(), "https://two.example");
  EXPECT_EQ(visitor.get("/api/v1/models").status, 200);
}

TEST_F(Reload, AFaultLeavesAllAsItWas) {
  write("public-url = https://two.example\nstop-timeout = soon\n");
  EXPECT_THAT(reload(), AllOf(HasSubstr("event=error"), HasSubstr("stays as it was"),
                              HasSubstr("vitrine.conf:2: stop-timeout: ")));
  EXPECT_EQ(origin(), "https://one.example");
  write("public-url = https://two.example\nnonsense = 1\n");
  EXPECT_THAT(reload(), HasSubstr("unknown key 'nonsense'"));
  write("public-url = https://two.example\n");
  reload();
  EXPECT_EQ(origin(), "https://two.example");
}

TEST_F(Reload, WhatNeedsANewStartSaysSo) {
  write("public-url = https://two.example\nmin-rate = 300\n");
  EXPECT_THAT(reload(), HasSubstr("new: public-url"));
  EXPECT_THAT(daemon->wait_for_line("restart"), HasSubstr("to apply the new min-rate"));
}

TEST_F(Reload, FewerConnectionsAndLessPatienceHoldAtOnceAndWhoIsThereStays) {
  HttpClient visitor(daemon->port());
  EXPECT_EQ(visitor.get("/api/v1/models").status, 200);
  write("public-url = https://one.example\nmax-connections = 1\n");
  EXPECT_THAT(reload(), HasSubstr("new: max-connections"));
  EXPECT_EQ(HttpClient(daemon->port()).receive().status, 503);
  EXPECT_EQ(visitor.get("/api/v1/models").status, 200);
  write("public-url = https://one.example\nidle-timeout = 1\n");
  EXPECT_THAT(reload(), HasSubstr("idle-timeout"));
  HttpClient slow(daemon->port());
  slow.send("GET / HTTP/1.1\r\n");
  // The old timeout is longer than the time that is_closed() waits for the end of the connection.
  EXPECT_TRUE(slow.is_closed());
}

TEST_F(Reload, TheDiskReserveIsStatedToProgramsThatPublishWithoutTheDaemon) {
  write("public-url = https://one.example\ndisk-reserve = 5000\n");
  EXPECT_THAT(reload(), HasSubstr("new: disk-reserve"));
  EXPECT_EQ(read_limits(served.path()).value().reserve, 5000u);
}

TEST_F(Reload, ARotatedLogIsOpenedAnew) {
  HttpClient visitor(daemon->port());
  // A request is in the log once the next request on the same connection has been answered.
  const auto visit = [&](const std::string& word) {
    EXPECT_EQ(visitor.get("/api/v1/models?q=" + word).status, 200);
    EXPECT_EQ(visitor.get("/api/v1/models").status, 200);
  };
  for (const int signal : {SIGHUP, SIGUSR1}) {
    const std::string number = std::to_string(signal);
    const auto rotated = served.path() / ("access.log." + number);
    visit("before" + number);
    std::filesystem::rename(served.path() / "access.log", rotated);
    daemon->signal(signal);
    daemon->wait_for_line(signal == SIGHUP ? "read again" : "access log reopened");
    visit("after" + number);
    std::ifstream old(rotated);
    const std::string lines{std::istreambuf_iterator<char>(old), {}};
    EXPECT_THAT(lines, AllOf(HasSubstr("q=before" + number), Not(HasSubstr("q=after" + number))));
    EXPECT_THAT(daemon->access_log(),
                AllOf(HasSubstr("q=after" + number), Not(HasSubstr("q=before" + number))));
  }
}

TEST_F(Reload, ALogThatIsFullIsReplaced) {
  HttpClient visitor(daemon->port());
  write("public-url = https://one.example\naccess-log-size = 10000\n");
  EXPECT_THAT(reload(), HasSubstr("new: access-log-size"));
  const auto old = served.path() / "access.log.old";
  for (int i = 0; i < 1000 && !std::filesystem::exists(old); ++i)
    EXPECT_EQ(visitor.get("/api/v1/models").status, 200);
  EXPECT_GE(std::filesystem::file_size(old), 10'000u);
  EXPECT_LT(daemon->access_log().size(), 10'000u);
}

// The request rate does not limit responses from memory, so only the log's own limit bounds the
// log.
TEST_F(Reload, ALogStaysBoundedHoweverFastResponsesFromMemoryAreSent) {
  constexpr std::uintmax_t kMost = 100'000, kBatch = 64 * 1024 + 500;
  write("public-url = https://one.example\naccess-log-size = 100000\n");
  reload();
  const std::string chunk = "/api/v1/chunks/" + to_hex(served_pmesh().manifest.chunks[0].sha256);
  EXPECT_EQ(http_get(daemon->port(), chunk).status, 200);
  std::string requests;
  for (int i = 0; i < 500; ++i)
    requests += "HEAD " + chunk + "?" + std::string(300, 'x') + " HTTP/1.1\r\nHost: a\r\n\r\n";
  const auto log = served.path() / "access.log", old = served.path() / "access.log.old";
  HttpClient visitor(daemon->port());
  for (int round = 0; round < 10; ++round) {
    visitor.send(requests);
    for (int i = 0; i < 500; ++i)
      visitor.receive(/*with_body=*/false);
    for (const auto& file : {log, old}) {
      std::error_code missing;  // set while the daemon replaces the file
      const auto size = std::filesystem::file_size(file, missing);
      EXPECT_TRUE(missing || size < kMost + 2 * kBatch) << size;
    }
  }
  EXPECT_TRUE(std::filesystem::exists(old));
}

TEST_F(Reload, ALogIsReopenedThoughTheConfigurationHasAFault) {
  std::filesystem::rename(served.path() / "access.log", served.path() / "rotated");
  write("nonsense = 1\n");
  reload();
  daemon->wait_for_line("access log reopened");
  EXPECT_TRUE(std::filesystem::exists(served.path() / "access.log"));
}

}  // namespace
}  // namespace vitrine::test
