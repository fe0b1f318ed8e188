// SPDX-License-Identifier: Apache-2.0
// Tests the event streams of jobs: they report the job's end, even if it ends while a client
// subscribes. A visitor's stream also ends when the job's model is withdrawn.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/messages/event_source.h"
#include "support/fake_backend.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

// Subscribes to the events of `job` as a client does. Returns the source of the events.
std::shared_ptr<EventSource> events_of(const JobId& job, Services& services,
                                       const std::optional<Caller>& caller = Caller{}) {
  const RequestHeader header{};
  const nlohmann::json body;
  const std::string form;
  const std::string id = job.to_string();
  PathParameters parameters;
  parameters.add("id", id);
  return show_job_events({.header = header,
                          .path = {},
                          .query = {},
                          .parameters = parameters,
                          .id = {},
                          .body = body,
                          .form = form,
                          .caller = caller},
                         services)
      .events;
}

TEST(JobEvents, WhoeverAsksForThemIsToldOfTheEnd) {
  LocalServer server(public_routes());
  auto& jobs = server.scans().jobs();
  for (int i = 0; i < 20; ++i) {
    JobRecord job;
    job.id = JobId::generate();
    job.kind = JobKind::kPublish;  // a job without parameters fails at once
    ASSERT_TRUE(jobs.add(job, std::nullopt, std::nullopt));
    std::vector<std::shared_ptr<EventSource>> watchers;
    do {
      watchers.push_back(events_of(job.id, server.services()));
    } while (!has_ended(jobs.find(job.id).value()->record.state));
    for (const auto& watcher : watchers) {
      watcher->next();
      ASSERT_TRUE(watcher->ended());
    }
  }
}

TEST(JobEvents, WhoeverKnowsTheEndIsToldNotToComeBack) {
  LocalServer server(public_routes());
  JobRecord job;
  job.id = JobId::generate();
  job.kind = JobKind::kPublish;  // a job without parameters fails at once
  ASSERT_TRUE(server.scans().jobs().add(job, std::nullopt, std::nullopt));
  const std::string path = "/api/v1/jobs/" + job.id.to_string() + "/events";
  const std::string who = server.bearer(Role::kViewer);
  HttpClient client(server.port());
  client.send("GET " + path + " HTTP/1.1\r\nHost: a\r\n" + who + "\r\n");
  EXPECT_EQ(client.receive().status, 200);
  std::string events;
  while (!events.ends_with("\nid: failed\n"))
    events += client.read_exactly(1);
  const auto again = [&](const std::string& known) {
    HttpClient next(server.port());
    next.send("GET " + path + " HTTP/1.1\r\nHost: a\r\nLast-Event-ID: " + known + "\r\n" + who +
              "\r\n");
    return next.receive().status;
  };
  EXPECT_EQ(again("failed"), 204);
  EXPECT_EQ(again("running-0.500"), 200);
}

// A server with a scan that failed and was made into a public model. The scan is now being measured
// again.
class ResumedScan : public ::testing::Test {
 protected:
  ResumedScan() {
    world_.before_step = [](int step) -> std::optional<Error> {
      if (step < 3) return std::nullopt;
      return Error{ErrorCode::kIo, "camera 42 is gone; check its cable"};
    };
    EXPECT_TRUE(server_.scans().start());
    const ScanOrder order{
        .scanner = "rig", .request = {.steps = 12}, .metadata = {.title = "A"}, .is_public = true};
    scan_ = server_.scans().scan(order, std::nullopt)->scan;
    settle("rig");
    const JobId job = server_.scans().reprocess(entry(), order, std::nullopt)->job;
    settle("");
    const JobRecord made = (*server_.scans().jobs().find(job))->record;
    EXPECT_EQ(made.state, JobState::kDone) << made.error;
    model_ = made.model.value();
    held_.emplace(world_, 5);
    EXPECT_TRUE(server_.scans().resume(entry()));
    held_->await();
  }
  ~ResumedScan() override { held_->open(); }

  static std::vector<std::unique_ptr<ScannerBackend>> one(FakeScanner& world) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<FakeBackend>(world));
    return backends;
  }
  void settle(const std::string& executor) {
    server_.scans().jobs().executor(executor).run([] {});
  }
  ScanEntry entry() { return (*server_.scans().find(scan_))->entry; }
  std::string path() { return "/api/v1/jobs/" + entry().job.to_string(); }

  // Subscribes to the events of the scan's job, and receives the first event.
  void watch(HttpClient& client, const std::string& who) {
    client.send("GET " + path() + "/events HTTP/1.1\r\nHost: a\r\n" + who + "\r\n");
    EXPECT_EQ(client.receive().status, 200);
    read_until(client, R"("state":"running")");
  }
  static void read_until(HttpClient& client, const std::string& text) {
    std::string events;
    while (events.find(text) == std::string::npos || !events.ends_with("\n\n"))
      events += client.read_exactly(1);
  }

  FakeScanner world_;
  LocalServer server_{public_routes(), std::chrono::seconds(30), one(world_)};
  ScanId scan_;
  ModelId model_;
  std::optional<HeldAtStep> held_;
};

TEST_F(ResumedScan, ItsEventsEndForVisitorsWhenItsModelIsWithdrawn) {
  HttpClient visitor(server_.port()), viewer(server_.port());
  watch(visitor, "");
  watch(viewer, server_.bearer(Role::kViewer));
  ASSERT_TRUE(server_.catalogue().set_state(model_, ModelState::kDraft));
  EXPECT_TRUE(visitor.is_closed());
  EXPECT_EQ(http_get(server_.port(), path()).status, 401);
  held_->open();
  read_until(viewer, R"("state":"done")");
}

TEST_F(ResumedScan, CheckingItsEventsOpensNoFile) {
  Services& services = server_.services();
  const auto events = events_of(entry().job, services, std::nullopt);
  ASSERT_TRUE(events);
  ModelRecord model = server_.catalogue().find(model_).value().value();
  model.title = "B";
  ASSERT_TRUE(server_.catalogue().update(model, std::nullopt));
  services.models.refresh();
  const std::uint64_t opened = services.models.misses;
  EXPECT_TRUE(events->may_continue());
  model = server_.catalogue().find(model_).value().value();
  model.public_part = PublicPart{.max_level = 0, .file = Sha256{1}};
  ASSERT_TRUE(server_.catalogue().update(model, std::nullopt));
  services.models.refresh();
  EXPECT_FALSE(events->may_continue());
  EXPECT_EQ(services.models.misses, opened);
}

TEST(JobEvents, ThoseOfANewModelGoOnBeforeItsFileIsOpened) {
  FakeScanner world;
  std::vector<std::unique_ptr<ScannerBackend>> backends;
  backends.push_back(std::make_unique<FakeBackend>(world));
  LocalServer server(public_routes(), std::chrono::seconds(30), std::move(backends));
  ASSERT_TRUE(server.scans().start());
  HeldAtStep held(world, 5);
  const auto order = server.scans().scan(
      {.scanner = "rig", .request = {.steps = 12}, .metadata = {.title = "A"}, .is_public = true},
      std::nullopt);
  ASSERT_TRUE(order);
  held.await();
  Services& services = server.services();
  const auto events = events_of(order->job, services, std::nullopt);
  ASSERT_TRUE(events);
  EXPECT_TRUE(events->may_continue());
  held.open();
  server.scans().jobs().executor("rig").run([] {});
  EXPECT_TRUE(events->may_continue());
  EXPECT_EQ(services.models.misses, 0u);
  const ModelId id = server.scans().find(order->scan).value()->entry.model.value();
  ModelRecord model = server.catalogue().find(id).value().value();
  model.public_part = PublicPart{.max_level = 0, .file = Sha256{1}};
  ASSERT_TRUE(server.catalogue().update(model, std::nullopt));
  services.models.refresh();
  EXPECT_FALSE(events->may_continue()) << "a level is hidden";
}

}  // namespace
}  // namespace vitrine::test
