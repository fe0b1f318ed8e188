// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/jobs/clock.h"
#include "server/store/installation.h"
#include "support/daemon.h"
#include "support/temporary_folder.h"
#include "support/webhook_listener.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

TEST(WebhooksOfADaemon, WhatAnotherHasNotToldIsToldAtTheStart) {
  const TemporaryFolder folder;
  const Installation installation = open_installation({.folder = folder.path()}).value();
  WebhookListener listener;
  const JobRecord ended{.id = JobId::generate(),
                        .kind = JobKind::kPublish,
                        .state = JobState::kDone,
                        .ended = now_in_milliseconds(),
                        .webhook = "http://" + listener.host() + "/told"};
  ASSERT_TRUE(installation.jobs->add(ended, std::nullopt, std::nullopt));
  const Daemon daemon(folder.path(), {"--webhook-hosts", listener.host()});
  EXPECT_THAT(listener.hear("200 OK"), HasSubstr("{\"id\":\"" + ended.id.to_string()));
  while (!installation.jobs->untold_jobs().value().empty())
    std::this_thread::yield();
}

}  // namespace
}  // namespace vitrine::test
