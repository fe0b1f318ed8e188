// SPDX-License-Identifier: Apache-2.0
// The events of jobs that end while a client subscribes to these events.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/messages/event_source.h"
#include "support/local_server.h"
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

}  // namespace
}  // namespace vitrine::test
