// SPDX-License-Identifier: Apache-2.0
// More work than there is room for.
#include <gtest/gtest.h>

#include <semaphore>

#include "local_server.h"
#include "support/http_client.h"

namespace vitrine {
namespace {

std::counting_semaphore<8> entered{0}, may_end{0};

Response wait_for_the_test(const Request&, Services&) {
  entered.release();
  may_end.acquire();
  return {};
}

Response at_once(const Request&, Services&) {
  return {};
}

constexpr Route kRoutes[] = {
    {Method::kGet, "/slow", wait_for_the_test, Place::kExport},
    {Method::kPost, "/work", wait_for_the_test, Place::kWorker},
    {Method::kPost, "/device", wait_for_the_test, Place::kDevice},
    {Method::kGet, "/quick", at_once, Place::kInline},
    {Method::kPost, "/quick", at_once, Place::kWorker},
};

TEST(Overload, AFullExportQueueIsAnsweredWithRetryAfterUntilASeatIsFree) {
  const test::LocalServer server(kRoutes);  // one seat for exports
  test::HttpClient first(server.port());
  first.send("GET /slow HTTP/1.1\r\nHost: a\r\n\r\n");
  entered.acquire();
  const test::HttpAnswer refused = test::http_get(server.port(), "/slow");
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.field("retry-after"), "5");
  EXPECT_EQ(refused.field("content-type"), "application/problem+json");
  may_end.release();
  EXPECT_EQ(first.receive().status, 200);
  may_end.release();
  EXPECT_EQ(test::http_get(server.port(), "/slow").status, 200);
}

TEST(Overload, ACallThatWaitsHoldsUpNoOtherConnection) {
  const test::LocalServer server(kRoutes);  // one thread for connections
  for (const std::string path : {"/work", "/device"}) {
    test::HttpClient waiting(server.port());
    waiting.send("POST " + path + " HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n");
    entered.acquire();
    EXPECT_EQ(test::http_get(server.port(), "/quick").status, 200);
    may_end.release();
    EXPECT_EQ(waiting.receive().status, 200);
  }
}

TEST(Overload, CallsThatWaitForDevicesLeaveTheWorkersToOthers) {
  const test::LocalServer server(kRoutes);
  std::vector<std::unique_ptr<test::HttpClient>> waiting;
  for (int i = 0; i < 4; ++i) {  // as many as there are threads for devices
    waiting.push_back(std::make_unique<test::HttpClient>(server.port()));
    waiting.back()->send("POST /device HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n");
    entered.acquire();
  }
  EXPECT_EQ(test::http_get(server.port(), "/quick", "Content-Length: 0\r\n", "POST").status, 200);
  may_end.release(4);
  for (const auto& client : waiting)
    EXPECT_EQ(client->receive().status, 200);
}

}  // namespace
}  // namespace vitrine
