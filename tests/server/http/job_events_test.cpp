// SPDX-License-Identifier: Apache-2.0
// The events of jobs that end while somebody asks for them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "local_server.h"
#include "server/http/event_source.h"
#include "server/http/handlers.h"
#include "server/http/routes.h"

namespace vitrine::test {
namespace {

// Its events as whoever asks for them now is given them.
std::shared_ptr<EventSource> events_of(const JobId& job, Services& services) {
  const RequestHeader header{};
  const nlohmann::json body;
  const std::optional<Caller> caller = Caller{};
  return show_job_events({.header = header,
                          .path = {},
                          .query = {},
                          .parameters = {.id = job},
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
    job.kind = JobKind::kPublish;  // without parameters: it fails at once
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
