// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "server/jobs/clock.h"
#include "server/store/installation.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"
#include "support/temporary_folder.h"
#include "support/webhook_listener.h"

namespace vitrine::test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

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
  const Daemon daemon(folder.path(), {"--webhook-hosts", listener.host(), "--webhook-secret",
                                      "whsec_MDEyMzQ1Njc4OTAxMjM0NTY3ODkwMTIzNDU2Nzg5MDE="});
  const std::string request = listener.hear("200 OK");
  EXPECT_THAT(request, HasSubstr("{\"id\":\"" + ended.id.to_string()));
  EXPECT_THAT(request, HasSubstr("\r\nwebhook-id: " + ended.id.to_string() + "\r\n"));
  EXPECT_THAT(request, HasSubstr("\r\nwebhook-signature: v1,"));
  while (!installation.jobs->unnotified_jobs().value().empty())
    std::this_thread::yield();
}

// A daemon that makes models from uploads. It calls a webhook when a job has ended.
class OrderedModel : public testing::Test {
 protected:
  HttpAnswer post(const std::string& path, const std::string& fields, const std::string& body) {
    HttpClient client(daemon_.port());
    client.send("POST /api/v1/" + path + " HTTP/1.1\r\nHost: a\r\n" + who_ + fields +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive();
  }
  // Uploads `file` and requests a model of it. Returns the JSON of the response.
  Json order(const std::string& file) {
    const std::string location =
        post("uploads",
             "Tus-Resumable: 1.0.0\r\nUpload-Length: " + std::to_string(file.size()) +
                 "\r\nContent-Type: application/offset+octet-stream\r\n",
             file)
            .field("location");
    const Json order = {{"upload", location.substr(location.rfind('/') + 1)},
                        {"webhook", "http://" + listener_.host() + "/told"}};
    const HttpAnswer accepted = post("models", "Content-Type: application/json\r\n", order.dump());
    EXPECT_EQ(accepted.status, 202) << accepted.body;
    return Json::parse(accepted.body);
  }
  // Waits until the daemon calls the webhook. Returns the job that the call reports.
  Json told() {
    const std::string request = listener_.hear("200 OK");
    EXPECT_THAT(request, StartsWith("POST /told HTTP/1.1\r\n"));
    return Json::parse(request.substr(request.find("\r\n\r\n")));
  }

  ServedFolder folder_;
  WebhookListener listener_;
  const std::string who_ = "Authorization: Bearer " + folder_.token(Role::kOperator) + "\r\n";
  const Daemon daemon_{folder_.path(), {"--webhook-hosts", listener_.host()}};
};

TEST_F(OrderedModel, TheWebhookTellsWhatHasBecomeOfTheJob) {
  const Json accepted = order("no mesh");
  const Json job = told();
  EXPECT_EQ(job["id"], accepted["job"]);
  EXPECT_EQ(job["state"], "failed");
}

TEST_F(OrderedModel, ThePostersAreMadeBeforeTheJobEnds) {
  order("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const Json job = told();
  ASSERT_EQ(job["state"], "done") << job;
  const std::string metrics = http_get(daemon_.admin_port(), "/metrics").body;
  EXPECT_THAT(metrics, HasSubstr("\nvitrine_exports_made_total 3\n"));
}

}  // namespace
}  // namespace vitrine::test
