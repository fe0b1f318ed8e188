// SPDX-License-Identifier: Apache-2.0
// Tests the events of jobs that end while a client subscribes to these events.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/messages/event_source.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

// Returns the events of `job` as a client that subscribes now receives them.
std::shared_ptr<EventSource> events_of(const JobId& job, Services& services) {
  const RequestHeader header{};
  const nlohmann::json body;
  const std::optional<Caller> caller = Caller{};
  const std::string id = job.to_string();
  PathParameters parameters;
  parameters.add("id", id);
  return show_job_events({.header = header,
                          .path = {},
                          .query = {},
                          .parameters = parameters,
                          .id = {},
                          .body = body,
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

}  // namespace
}  // namespace vitrine::test
