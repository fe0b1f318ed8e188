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
  const Daemon daemon(folder.path(), {"--webhook-hosts", listener.host()});
  EXPECT_THAT(listener.hear("200 OK"), HasSubstr("{\"id\":\"" + ended.id.to_string()));
  while (!installation.jobs->unnotified_jobs().value().empty())
    std::this_thread::yield();
}

TEST(WebhooksOfADaemon, WhoOrdersAModelIsToldWhatHasBecomeOfIt) {
  ServedFolder folder;
  WebhookListener listener;
  const std::string who = "Authorization: Bearer " + folder.token(Role::kOperator) + "\r\n";
  const Daemon daemon(folder.path(), {"--webhook-hosts", listener.host()});
  const auto post = [&](const std::string& path, const std::string& fields,
                        const std::string& body) {
    HttpClient client(daemon.port());
    client.send("POST /api/v1/" + path + " HTTP/1.1\r\nHost: a\r\n" + who + fields +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive();
  };
  const std::string location = post("uploads",
                                    "Tus-Resumable: 1.0.0\r\nUpload-Length: 7\r\n"
                                    "Content-Type: application/offset+octet-stream\r\n",
                                    "no mesh")
                                   .field("location");
  const Json order = {{"upload", location.substr(location.rfind('/') + 1)},
                      {"webhook", "http://" + listener.host() + "/told"}};
  const HttpAnswer accepted = post("models", "Content-Type: application/json\r\n", order.dump());
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::string request = listener.hear("200 OK");
  EXPECT_THAT(request, StartsWith("POST /told HTTP/1.1\r\n"));
  const Json told = Json::parse(request.substr(request.find("\r\n\r\n")));
  EXPECT_EQ(told["id"], Json::parse(accepted.body)["job"]);
  EXPECT_EQ(told["state"], "failed");
}

}  // namespace
}  // namespace vitrine::test
