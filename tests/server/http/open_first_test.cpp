// SPDX-License-Identifier: Apache-2.0
// Tests that a request does not occupy a worker while it waits for a file to be opened.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "server/http/http_server.h"
#include "server/store/installation.h"
#include "support/process/http_client.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

class OpenFirst : public ::testing::Test {
 protected:
  ~OpenFirst() override {
    may_open_.set_value();
    io_.stop();
    thread_.join();
    workers_.stop();
    workers_.join();
  }
  std::uint16_t port() const { return port_; }

  std::promise<void> may_open_;
  std::atomic<int> opened_ = 0;

 private:
  std::vector<Route> routes() {
    const Handler empty = [](const Request&) { return Response{}; };
    const auto opens = [this](const Request&) -> std::optional<Opening> {
      if (opened_ > 0) return std::nullopt;
      return Opening{"large", [this] {
                       opening_.wait();
                       ++opened_;
                       return true;
                     }};
    };
    return {{.path = "/large", .handler = empty, .opens = opens, .executor = Executor::kWorker},
            {.path = "/other", .handler = empty, .executor = Executor::kWorker}};
  }

  const std::shared_future<void> opening_ = may_open_.get_future().share();
  test::TemporaryFolder folder_;
  Installation installation_ = open_installation({.folder = folder_.path()}).value();
  asio::io_context io_;
  Authenticator tokens_{*installation_.catalogue};
  Workers workers_{{.threads = 1}};
  Metrics metrics_{std::vector<std::string_view>{"/large", "/other"}};
  Log log_ = Log::open("").value();
  HttpServer server_{io_,
                     {.tokens = tokens_,
                      .workers = workers_,
                      .metrics = metrics_,
                      .access_log = log_,
                      .events = log_},
                     {.routes = routes(), .max_connections = 16}};
  const std::uint16_t port_ = server_.listen({"127.0.0.1", 0}).value();
  std::thread thread_{[this] {
    server_.start();
    io_.run();
  }};
};

TEST_F(OpenFirst, RequestsThatWaitForAFileLeaveTheOnlyWorkerToOthers) {
  std::vector<std::unique_ptr<test::HttpClient>> waiting;
  for (int i = 0; i < 5; ++i) {
    waiting.push_back(std::make_unique<test::HttpClient>(port()));
    waiting.back()->send("GET /large HTTP/1.1\r\nHost: a\r\n\r\n");
  }
  EXPECT_EQ(test::http_get(port(), "/other").status, 200);
  EXPECT_EQ(opened_, 0);
  may_open_.set_value();
  for (const auto& client : waiting)
    EXPECT_EQ(client->receive().status, 200);
  EXPECT_GE(opened_, 1);
  may_open_ = {};
}

}  // namespace
}  // namespace vitrine::server
