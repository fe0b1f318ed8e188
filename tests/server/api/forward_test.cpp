// SPDX-License-Identifier: Apache-2.0
// Tests that a daemon forwards the requests for a scanner to the daemon that drives it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>
#include <future>
#include <nlohmann/json.hpp>

#include "codec/files/file_descriptor.h"
#include "server/api/routes.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "support/fake_backend.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/uninterrupted.h"
#include "support/webhook_listener.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class PassedOn : public testing::Test {
 protected:
  PassedOn() {
    EXPECT_TRUE(driver_.scans().start());
    const auto address = "http://127.0.0.1:" + std::to_string(driver_.port());
    EXPECT_TRUE(jobs_->take_scanner("rig", {"driver", 1h}, address));
    claims_.beat();
    const auto tokens = driver_.catalogue().tokens().value();
    for (const TokenRecord& token : tokens)
      EXPECT_TRUE(front_.catalogue().add_token(token));
  }

  static std::vector<std::unique_ptr<ScannerBackend>> one(test::FakeScanner& world) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(world));
    return backends;
  }
  test::HttpAnswer ask(const std::string& method, const std::string& path, const std::string& who,
                       const std::string& body = "") {
    test::HttpClient client(front_.port());
    client.send(method + " /api/v1" + path + " HTTP/1.1\r\nHost: a\r\n" + who +
                "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
                "\r\n\r\n" + body);
    return client.receive();
  }

  // Begins a scan and adds it to the catalogues of both daemons. Returns its id.
  std::string new_scan() {
    const auto begun = ask("POST", "/scans", operator_, R"({"scanner": "rig", "steps": 12})");
    const auto id = json::parse(begun.body)["id"].get<std::string>();
    const ScanEntry scan = driver_.jobs().find_scan(ScanId::parse(id).value()).value().value();
    const JobRecord job = driver_.jobs().find_job(scan.job).value().value();
    EXPECT_TRUE(front_.jobs().add(job, scan, {}));
    return id;
  }
  static HttpOptions behind_proxies() { return {.proxies = Networks::parse("127.0.0.1").value()}; }

  test::FakeScanner world_;
  test::LocalServer driver_{public_routes(), std::chrono::seconds(30), one(world_),
                            behind_proxies()};
  const std::string operator_ = driver_.bearer(Role::kOperator);
  test::TemporaryFolder folder_;
  std::unique_ptr<JobCatalogue> jobs_ =
      open_sqlite_jobs(folder_.path() / "catalogue.sqlite").value();
  ScannerClaims claims_{*jobs_, Log::open("").value(), {"front", 1h}, ""};
  test::LocalServer front_{
      public_routes(), std::chrono::seconds(30), {}, behind_proxies(), &claims_};
};

TEST_F(PassedOn, CommandsReachTheScannerAndTheirAnswersTheCaller) {
  EXPECT_EQ(ask("POST", "/scanners/rig/jog", operator_, R"({"degrees": 90})").status, 200);
  EXPECT_EQ(world_.degrees, 90);
  EXPECT_EQ(ask("POST", "/scanners/rig/jog", operator_, R"({"radians": 1})").status, 422);
  EXPECT_EQ(ask("POST", "/scanners/rig/laser", operator_, R"({"on": true})").status, 200);
  EXPECT_TRUE(world_.laser);
  const auto picture = ask("GET", "/scanners/rig/preview", operator_);
  EXPECT_EQ(picture.field("content-type"), "image/png");
  EXPECT_EQ(picture.body.substr(1, 3), "PNG");
  EXPECT_EQ(ask("POST", "/scanners/rig/stop", operator_).status, 200);
  EXPECT_EQ(world_.stops, 1u);
}

TEST_F(PassedOn, NoProxyOfTheEnvironmentIsAsked) {
  ::setenv("http_proxy", "http://127.0.0.1:1", 1);
  const auto answer = ask("GET", "/scanners/rig", operator_);
  ::unsetenv("http_proxy");
  EXPECT_EQ(answer.status, 200) << answer.body;
}

// Neither of the other daemons answers until both have been asked, so the front daemon must ask
// them concurrently.
TEST_F(PassedOn, ListsAskAllDaemonsAtOnce) {
  test::WebhookListener left, right;
  for (const auto& [name, daemon] : {std::pair("left", &left), std::pair("right", &right)})
    ASSERT_TRUE(jobs_->take_scanner(name, {name, 1h}, "http://" + daemon->host()));
  ASSERT_TRUE(jobs_->drop_scanners("driver"));
  claims_.beat();
  auto list = std::async(std::launch::async, [&] { return ask("GET", "/scanners", operator_); });
  std::string requests[2];
  const FileDescriptor first = left.accept(requests[0]), second = right.accept(requests[1]);
  test::WebhookListener::answer(first, "200 OK", R"({"scanners": [{"name": "left"}]})");
  test::WebhookListener::answer(second, "200 OK", R"({"scanners": [{"name": "right"}]})");
  EXPECT_EQ(json::parse(list.get().body)["scanners"].size(), 2u);
}

TEST_F(PassedOn, TheListsOfAllAreOne) {
  const auto list = json::parse(ask("GET", "/scanners", operator_).body)["scanners"];
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["name"], "rig");
}

TEST_F(PassedOn, InAListThatNotAllHaveAnsweredTheirScannersAreUnreachable) {
  const auto expect_unreachable = [this] {
    const auto answer = ask("GET", "/scanners", operator_);
    EXPECT_EQ(answer.status, 200);
    const auto list = json::parse(answer.body)["scanners"];
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0]["name"], "rig");
    EXPECT_EQ(list[0]["state"], "unreachable");
    EXPECT_THAT(list[0]["problem"].get<std::string>(), testing::HasSubstr("has not responded"));
  };
  std::vector<AdmissionLimit::Pass> taken;
  for (std::size_t i = 0; i < Services::kMostForwarded; ++i)
    taken.push_back(front_.services().forwarded_for_callers->admit("").value());
  expect_unreachable();
  taken.clear();
  ASSERT_TRUE(jobs_->take_scanner("rig", {"driver", 1h}, "http://127.0.0.1:1"));
  claims_.beat();
  expect_unreachable();
}

TEST_F(PassedOn, AnAnswerThatIsNoListOfScannersIsNone) {
  test::WebhookListener stranger;
  ASSERT_TRUE(jobs_->take_scanner("rig", {"driver", 1h}, "http://" + stranger.host()));
  claims_.beat();
  const std::size_t deep = 200'000;
  for (const std::string& scanners :
       {std::string("{}"), std::string("[null]"), std::string(R"([{"name": 1}])"),
        std::string(deep, '[') + std::string(deep, ']')}) {
    auto answer =
        std::async(std::launch::async, [&] { return ask("GET", "/scanners", operator_); });
    std::string asked;
    test::WebhookListener::answer(stranger.accept(asked), "200 OK",
                                  R"({"scanners": )" + scanners + "}");
    const auto list = json::parse(answer.get().body)["scanners"];
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0]["name"], "rig");
    EXPECT_EQ(list[0]["state"], "unreachable");
  }
}

TEST_F(PassedOn, AScanBeginsWhereItsScannerIs) {
  const auto begun = ask("POST", "/scans", operator_, R"({"scanner": "rig", "steps": 12})");
  ASSERT_EQ(begun.status, 202) << begun.body;
  const auto job = JobId::parse(json::parse(begun.body)["job"].get<std::string>()).value();
  EXPECT_EQ(begun.field("location"), "/api/v1/jobs/" + job.to_string());
  EXPECT_TRUE(driver_.jobs().find_job(job).value());
}

TEST_F(PassedOn, AListOfScansTellsWhatTheirDriverTells) {
  const auto begun = ask("POST", "/scans", operator_, R"({"scanner": "rig", "steps": 12})");
  const auto id = ScanId::parse(json::parse(begun.body)["id"].get<std::string>()).value();
  const ScanEntry unknown{.id = id, .job = JobId::generate(), .scanner = "rig", .title = "Behind"};
  const JobRecord running{.id = unknown.job, .state = JobState::kRunning, .scanner = "rig"};
  // The front daemon's own catalogue has an outdated entry for the scan.
  ASSERT_TRUE(front_.jobs().add(running, unknown, {}));
  const auto list = json::parse(ask("GET", "/scans", operator_).body)["scans"];
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["steps"], 12);
  ASSERT_TRUE(jobs_->take_scanner("rig", {"driver", 1h}, "http://127.0.0.1:1"));
  claims_.beat();
  EXPECT_EQ(json::parse(ask("GET", "/scans", operator_).body)["scans"][0]["title"], "Behind");
}

TEST_F(PassedOn, WhoMayNotIsToldSoBefore) {
  EXPECT_EQ(ask("POST", "/scanners/rig/jog", "", R"({"degrees": 90})").status, 401);
  EXPECT_EQ(world_.degrees, 0);
}

TEST_F(PassedOn, ADaemonThatDoesNotAnswerIs503AndWhenToComeBack) {
  ASSERT_TRUE(jobs_->take_scanner("rig", {"driver", 1h}, "http://127.0.0.1:1"));
  claims_.beat();
  const auto answer = ask("GET", "/scanners/rig", operator_);
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer.field("retry-after"), "5");
}

TEST_F(PassedOn, ForADaemonWhoseLeaseIsOverNobodyWaits) {
  ASSERT_TRUE(jobs_->drop_scanners("driver"));
  claims_.beat();
  const auto answer = ask("GET", "/scanners/rig", operator_);
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer.field("retry-after"), "5");
}

TEST_F(PassedOn, WhatACallerIsToldIsForNobodyElse) {
  const std::string scan = "/scans/" + new_scan();
  const auto told = ask("GET", scan, operator_);
  EXPECT_EQ(told.status, 200) << told.body;
  EXPECT_EQ(told.field("cache-control"), "private, no-store");
  EXPECT_EQ(told.field("access-control-allow-origin"), "");
  const auto refused = ask("GET", scan, "");
  EXPECT_EQ(refused.status, 401);
  EXPECT_EQ(refused.field("www-authenticate"), "Bearer");
}

TEST_F(PassedOn, StrangersLeaveRoomForWhoHasAToken) {
  const std::string scan = "/scans/" + new_scan();
  std::vector<AdmissionLimit::Pass> taken;
  for (std::size_t i = 0; i < Services::kMostForwarded; ++i)
    taken.push_back(front_.services().forwarded_for_strangers->admit(std::to_string(i)).value());
  EXPECT_EQ(ask("GET", scan, "").status, 503);
  EXPECT_EQ(ask("GET", scan, operator_).status, 200);
  taken.clear();
  EXPECT_EQ(ask("GET", scan, "").status, 401);
}

TEST_F(PassedOn, AnEmergencyStopWaitsBehindNobody) {
  std::vector<AdmissionLimit::Pass> taken;
  for (std::size_t i = 0; i < Services::kMostForwarded; ++i)
    taken.push_back(front_.services().forwarded_for_callers->admit("").value());
  EXPECT_EQ(ask("GET", "/scanners/rig/preview", operator_).status, 503);
  EXPECT_EQ(ask("POST", "/scanners/rig/stop", operator_).status, 200);
  EXPECT_EQ(world_.stops, 1u);
}

// A daemon that hangs: it accepts connections but never answers.
class Hung {
 public:
  Hung() {
    sockaddr_in any{.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof any;
    const timeval timeout{.tv_sec = 20, .tv_usec = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&any), size), 0);
    EXPECT_EQ(::listen(socket_.get(), SOMAXCONN), 0);
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&any), &size), 0);
    address_ = "http://127.0.0.1:" + std::to_string(ntohs(any.sin_port));
  }
  const std::string& address() const { return address_; }
  void wait_for_visitor() {
    visitors_.emplace_back(
        test::uninterrupted([&] { return ::accept(socket_.get(), nullptr, nullptr); }));
    ASSERT_TRUE(visitors_.back());
  }

 private:
  const FileDescriptor socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::string address_;
  std::vector<FileDescriptor> visitors_;
};

// Requests that wait for a hung daemon must not occupy all workers of the forwarding daemon.
// Otherwise the watchdog would kill the forwarding daemon, too.
TEST_F(PassedOn, WhoWaitsForADaemonThatHangsLeavesWorkersForTheOthers) {
  const std::string scan = "/scans/" + new_scan();
  Hung hung;
  ASSERT_TRUE(jobs_->take_scanner("rig", {"driver", 1h}, hung.address()));
  claims_.beat();
  std::vector<std::unique_ptr<test::HttpClient>> waiting;
  const auto call = [&](const std::string& who) {
    waiting.push_back(std::make_unique<test::HttpClient>(front_.port()));
    waiting.back()->send("GET /api/v1" + scan + " HTTP/1.1\r\nHost: a\r\n" + who + "\r\n");
    hung.wait_for_visitor();
  };
  for (std::size_t i = 0; i < Services::kMostForwarded; ++i) {
    call(operator_);
    call("X-Forwarded-For: 192.0.2." + std::to_string(i) + "\r\n");
  }
  EXPECT_EQ(ask("GET", scan, operator_).status, 503);
  EXPECT_EQ(ask("GET", scan, "").status, 503);
  EXPECT_EQ(ask("GET", "/models", operator_).status, 200);
}

TEST_F(PassedOn, WhoAsksIsToldOn) {
  ask("POST", "/scanners/rig/laser", operator_ + "X-Forwarded-For: 192.0.2.9\r\n",
      R"({"on": true})");
  driver_.drain().get();
  EXPECT_THAT(driver_.events(), testing::HasSubstr("remote=192.0.2.9"));
}

TEST_F(PassedOn, WhatWasPassedOnIsNotPassedOnAgain) {
  EXPECT_EQ(ask("GET", "/scanners/rig", operator_ + "Vitrine-Passed-On: 1\r\n").status, 404);
}

}  // namespace
}  // namespace vitrine::server
