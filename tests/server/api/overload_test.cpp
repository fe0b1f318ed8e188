// SPDX-License-Identifier: Apache-2.0
// Tests the server under more load than it can accept.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <semaphore>
#include <thread>

#include "server/api/routes.h"
#include "server/config/networks.h"
#include "server/messages/body_sink.h"
#include "server/messages/problem.h"
#include "support/fake_backend.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

std::counting_semaphore<> entered{0}, may_end{0};

Response wait_for_the_test(const Request&, Services&) {
  entered.release();
  may_end.acquire();
  return {};
}

std::mutex turns_mutex;
std::vector<std::string> turns;  // client addresses, in the order in which requests ran

Response note_the_turn(const Request& request, Services& services) {
  {
    const std::scoped_lock lock(turns_mutex);
    turns.emplace_back(request.client_address);
  }
  return wait_for_the_test(request, services);
}

Response at_once(const Request&, Services&) {
  return {};
}

Response not_there(const Request& request, Services&) {
  return problem(404, "", request.id);
}

// Accepts any body. At the end of the body, waits until the test releases it.
class WaitingSink final : public BodySink {
 public:
  std::optional<Response> take(std::span<const std::uint8_t>) override { return std::nullopt; }
  Response finish() override {
    entered.release();
    may_end.acquire();
    return {};
  }
};

Response pour_slowly(const Request&, Services&) {
  Response response;
  response.sink = std::make_shared<WaitingSink>();
  return response;
}

constexpr std::size_t kLarge = 32'000'000;  // far more bytes than the buffers of two sockets hold

Response large_text(const Request&, Services&) {
  Response response;
  response.body = std::string(kLarge, 'a');
  return response;
}

Response shared_bytes(const Request&, Services&) {
  static const auto owner = std::make_shared<std::vector<std::uint8_t>>(kLarge);
  Response response;
  response.body = SharedBytes{owner, *owner};
  return response;
}

constexpr ApiRoute kCrowdedRoutes[] = {
    {.method = Method::kGet, .path = "/text", .handler = large_text, .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/shared",
     .handler = shared_bytes,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/slow",
     .handler = wait_for_the_test,
     .executor = Executor::kCompute},
    {.method = Method::kGet,
     .path = "/turn",
     .handler = note_the_turn,
     .executor = Executor::kCompute},
    {.method = Method::kGet,
     .path = "/read",
     .handler = wait_for_the_test,
     .executor = Executor::kWorker},
    {.method = Method::kPost,
     .path = "/work",
     .handler = wait_for_the_test,
     .executor = Executor::kWorker},
    {.method = Method::kPost,
     .path = "/device",
     .handler = wait_for_the_test,
     .executor = Executor::kDevice},
    {.method = Method::kPost,
     .path = "/disk",
     .handler = wait_for_the_test,
     .executor = Executor::kDisk},
    {.method = Method::kPost,
     .path = "/pour",
     .handler = pour_slowly,
     .executor = Executor::kDisk,
     .body = BodyKind::kPieces},
    {.method = Method::kGet, .path = "/quick", .handler = at_once, .executor = Executor::kInline},
    {.method = Method::kPost, .path = "/quick", .handler = at_once, .executor = Executor::kWorker},
    {.method = Method::kPost,
     .path = "/locked",
     .handler = at_once,
     .executor = Executor::kWorker,
     .role = Role::kOperator},
    {.method = Method::kGet,
     .path = "/missing",
     .handler = not_there,
     .executor = Executor::kInline},
};

std::string sent_from(const std::string& address) {
  return "X-Forwarded-For: " + address + "\r\n";
}

HttpOptions behind_a_proxy() {
  return {.proxies = Networks::parse("127.0.0.1").value()};
}

// More slow reads than the server has threads for them. The reads end with this object.
class SlowReads {
 public:
  static constexpr int kThreads = 2 + Services::kWaitingThreads, kReads = kThreads + 4;

  // Read number i comes from the address `address_of(i)`.
  SlowReads(std::uint16_t port, std::string (*address_of)(int)) {
    while (entered.try_acquire()) {  // discards what earlier tests have left
    }
    for (int i = 0; i < kReads; ++i) {
      clients_.push_back(std::make_unique<test::HttpClient>(port));
      clients_.back()->send("GET /read HTTP/1.1\r\nHost: a\r\n" + sent_from(address_of(i)) +
                            "\r\n");
    }
  }
  ~SlowReads() {
    may_end.release(kReads);
    wait_for(not_seen_);
  }
  SlowReads(const SlowReads&) = delete;
  SlowReads& operator=(const SlowReads&) = delete;

  void wait_until_all_threads_are_busy() {
    wait_for(kThreads);
    not_seen_ -= kThreads;
  }

 private:
  static void wait_for(int reads) {
    for (int i = 0; i < reads; ++i)
      entered.acquire();
  }

  std::vector<std::unique_ptr<test::HttpClient>> clients_;
  int not_seen_ = kReads;  // number of reads whose start the test has not awaited
};

TEST(Overload, AnAddressWithManySlowReadsDelaysNoReadOfAnother) {
  const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {}, behind_a_proxy());
  const SlowReads reads(server.port(), [](int) -> std::string { return "192.0.2.1"; });
  // One thread serves all connections, so it has read the slow requests before this one.
  const std::string other = sent_from("192.0.2.2") + "Content-Length: 0\r\n";
  EXPECT_EQ(test::http_get(server.port(), "/quick", other, "POST").status, 200);
}

// A server with a scanner, and an operator whose token the server must look up.
class ScannerToStop {
 public:
  ScannerToStop() { EXPECT_TRUE(server_.scans().start()); }

  test::LocalServer& server() { return server_; }
  void expect_that_a_stop_gets_through() {
    const auto answer = test::http_get(server_.port(), "/api/v1/scanners/rig/stop", who_, "POST");
    EXPECT_EQ(answer.status, 200);
    EXPECT_TRUE(world_.stopped());
  }

 private:
  static std::vector<ApiRoute> all_routes() {
    std::vector<ApiRoute> all(std::begin(kCrowdedRoutes), std::end(kCrowdedRoutes));
    all.insert(all.end(), public_routes().begin(), public_routes().end());
    return all;
  }
  std::vector<std::unique_ptr<ScannerBackend>> backends() {
    std::vector<std::unique_ptr<ScannerBackend>> made;
    made.push_back(std::make_unique<test::FakeBackend>(world_));
    return made;
  }

  test::FakeScanner world_;
  const std::vector<ApiRoute> routes_ = all_routes();
  test::LocalServer server_{routes_, std::chrono::seconds(30), backends(), behind_a_proxy()};
  const std::string who_ = server_.bearer(Role::kOperator) + "Content-Length: 0\r\n";
};

TEST(Overload, SlowReadsOfManyAddressesDelayNoEmergencyStop) {
  ScannerToStop scanner;
  SlowReads reads(scanner.server().port(), [](int i) { return "192.0.2." + std::to_string(i); });
  reads.wait_until_all_threads_are_busy();
  scanner.expect_that_a_stop_gets_through();
}

TEST(Overload, AReadThatHoldsTheConnectionToTheCatalogueDelaysNoEmergencyStop) {
  ScannerToStop scanner;
  const auto held = scanner.server().database().lease();
  scanner.expect_that_a_stop_gets_through();
}

TEST(Overload, SlowLookupsOfTokensDelayNoEmergencyStopFromTheirNetwork) {
  ScannerToStop scanner;
  asio::io_context io;
  std::counting_semaphore<> lookups_may_end(0);
  constexpr int kLookups = 8;
  for (int i = 0; i < kLookups; ++i) {
    asio::co_spawn(asio::make_strand(io),
                   scanner.server().workers().look_up_token(network_of("127.0.0.1"),
                                                            [&] { lookups_may_end.acquire(); }),
                   asio::detached);
  }
  io.poll();
  scanner.expect_that_a_stop_gets_through();
  lookups_may_end.release(kLookups);
  io.restart();
  io.run();
}

TEST(Overload, AFullExportQueueIsAnsweredWithRetryAfterUntilASeatIsFree) {
  const test::LocalServer server(kCrowdedRoutes);  // the server admits one export at a time
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

TEST(Overload, OneAddressHasAQuarterOfTheSeatsForExports) {
  const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {}, behind_a_proxy(),
                                 nullptr, 4);
  test::HttpClient first(server.port()), other(server.port());
  first.send("GET /slow HTTP/1.1\r\nHost: a\r\n" + sent_from("192.0.2.1") + "\r\n");
  entered.acquire();
  const test::HttpAnswer refused = test::http_get(server.port(), "/slow", sent_from("192.0.2.1"));
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(refused.field("retry-after"), "5");
  other.send("GET /slow HTTP/1.1\r\nHost: a\r\n" + sent_from("192.0.2.2") + "\r\n");
  may_end.release(2);
  EXPECT_EQ(first.receive().status, 200);
  EXPECT_EQ(other.receive().status, 200);
  entered.acquire();
}

TEST(Overload, AClientWithManyExportsDelaysThoseOfAnotherByOneOnly) {
  const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {}, behind_a_proxy(),
                                 nullptr, 64);
  std::vector<std::unique_ptr<test::HttpClient>> clients;
  const auto ask = [&](const std::string& query, const std::string& address) {
    clients.push_back(std::make_unique<test::HttpClient>(server.port()));
    clients.back()->send("GET /turn?" + query +
                         " HTTP/1.1\r\nHost: a\r\nX-Forwarded-For: " + address + "\r\n\r\n");
  };
  while (entered.try_acquire()) {  // discards what earlier tests have left
  }
  for (int i = 0; i < 8; ++i)
    ask(std::to_string(i), "192.0.2.1");
  // Waits until two exports run, the largest number that may run at a time.
  entered.acquire(), entered.acquire();
  ask("other", "192.0.2.2");
  // One thread serves all connections, so it has read the request to `other` before this one.
  EXPECT_EQ(test::http_get(server.port(), "/quick").status, 200);
  may_end.release();
  entered.acquire();
  {
    const std::scoped_lock lock(turns_mutex);
    EXPECT_EQ(turns.back(), "192.0.2.2");
  }
  may_end.release(8);
  for (const auto& client : clients)
    EXPECT_EQ(client->receive().status, 200);
  for (int i = 0; i < 6; ++i)
    entered.acquire();
}

TEST(Overload, AnAnswerThatNeverFitsIsSaidToBeTooLarge) {
  const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {},
                                 {.answer_memory = kLarge - 1});
  const test::HttpAnswer refused = test::http_get(server.port(), "/text");
  EXPECT_EQ(refused.status, 507);
  EXPECT_NE(refused.body.find("answer-memory"), std::string::npos);
  EXPECT_EQ(test::http_get(server.port(), "/text", "", "HEAD").status, 200);
}

TEST(Overload, ACallThatWaitsHoldsUpNoOtherConnection) {
  const test::LocalServer server(kCrowdedRoutes);  // one thread serves all connections
  for (const std::string path : {"/work", "/device"}) {
    test::HttpClient waiting(server.port());
    waiting.send("POST " + path + " HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n");
    entered.acquire();
    EXPECT_EQ(test::http_get(server.port(), "/quick").status, 200);
    may_end.release();
    EXPECT_EQ(waiting.receive().status, 200);
  }
}

TEST(Overload, CallsThatWaitForDevicesOrTheDiskLeaveTheWorkersToOthers) {
  const test::LocalServer server(kCrowdedRoutes);
  for (const std::string path : {"/device", "/disk", "/pour"}) {
    std::vector<std::unique_ptr<test::HttpClient>> waiting;
    for (int i = 0; i < 4; ++i) {  // the executors have four threads each
      waiting.push_back(std::make_unique<test::HttpClient>(server.port()));
      waiting.back()->send("POST " + path + " HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n");
      entered.acquire();
    }
    EXPECT_EQ(test::http_get(server.port(), "/quick", "Content-Length: 0\r\n", "POST").status, 200);
    may_end.release(4);
    for (const auto& client : waiting)
      EXPECT_EQ(client->receive().status, 200) << path;
  }
}

TEST(Overload, WhatChangesModelsOrUploadsWaitsForTheDiskApart) {
  for (const ApiRoute& route : public_routes()) {
    const bool writes = route.method != Method::kGet && route.method != Method::kOptions;
    const bool is_counted_in_memory = route.path.ends_with("/visits");
    const bool stores = !is_counted_in_memory && (route.path.starts_with("/api/v1/models") ||
                                                  route.path.starts_with("/api/v1/uploads"));
    if (writes && stores) {
      EXPECT_EQ(route.executor, Executor::kDisk) << route.path;
    }
    if (route.path.ends_with("/stop")) {
      EXPECT_EQ(route.executor, Executor::kUrgent);
    }
  }
}

TEST(Overload, AnswersThatNobodyTakesHoldNoMoreMemoryThanTheyMay) {
  const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {},
                                 {.answer_memory = kLarge / 2 * 3});
  const auto ask = [&](const std::string& path) {
    auto reader = std::make_unique<test::HttpClient>(server.port());
    reader->send("GET " + path + " HTTP/1.1\r\nHost: a\r\n\r\n");
    return reader;
  };
  for (const std::string path : {"/text", "/shared"}) {
    auto first = ask(path);
    while (first->receive(/*with_body=*/false).status ==
           503)  // repeats until earlier responses have freed their memory
      first = ask(path);
    const test::HttpAnswer refused = test::http_get(server.port(), "/text");
    EXPECT_EQ(refused.status, 503) << path;
    EXPECT_EQ(refused.field("retry-after"), "5");
    EXPECT_EQ(test::http_get(server.port(), "/quick").status, 200);
    EXPECT_EQ(test::http_get(server.port(), "/text", "", "HEAD").status, 200);
    if (path == "/shared") {  // a second response with the same body takes no more memory
      EXPECT_EQ(ask(path)->receive(false).status, 200);
    }
    first->read_exactly(kLarge);
  }
}

// The pauses between the reads are shorter than the idle timeout, and the client receives far more
// than `min_rate`.
TEST(Overload, AClientThatTakesAnAnswerFromMemoryTooSlowlyIsCutOff) {
  const test::LocalServer server(
      kCrowdedRoutes, std::chrono::seconds(1), {},
      {.min_rate = 1, .min_memory_rate = 1'000'000'000, .answer_memory = 8 * kLarge});
  for (const std::string path : {"/text", "/shared"}) {
    test::HttpClient client(server.port());
    client.send("GET " + path + " HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_THROW(
        for (int i = 0; i < 300; ++i) {
          client.read_exactly(100'000);
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
        },
        std::runtime_error)
        << path;
  }
}

// Whether a client that accepts `rate` bytes per second receives all of a text of this size.
bool receives_all(const test::LocalServer& server, std::uint64_t size, std::uint64_t rate) {
  const Pace pace = server.pace_of(std::string(size, 'a'));
  std::chrono::seconds elapsed{0};
  std::uint64_t sent = 0;
  for (; sent < size && pace.time_left(sent, elapsed).count() > 0; sent += rate)
    ++elapsed;
  return sent >= size;
}

TEST(Overload, ASlowPhoneReceivesModestAnswersButDoesNotOccupyALargePartOfTheMemory) {
  constexpr std::uint64_t kModest = 2'000'000;
  const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {},
                                 {.min_rate = 256, .answer_memory = 64 * kModest});
  EXPECT_TRUE(receives_all(server, kModest, 2'500));
  EXPECT_FALSE(receives_all(server, kModest, 1'500));
  EXPECT_FALSE(receives_all(server, kModest + 1, 2'500));
  EXPECT_FALSE(receives_all(server, kModest + 1, 15'000));
  EXPECT_TRUE(receives_all(server, kModest + 1, 25'000));
  EXPECT_TRUE(receives_all(server, BodiesInFlight::kSmall - 1, 300));
}

// The server answers each of these requests with an error, or with the list of methods, without
// reading the disk. Each answer comes from a different part of the server.
TEST(Overload, ErrorsAndOptionsCountTowardsTheRateAndOtherAnswersFromMemoryDoNot) {
  for (const std::string request :
       {"GET /nothing HTTP/1.1\r\nHost: a\r\n\r\n", "PUT /quick HTTP/1.1\r\nHost: a\r\n\r\n",
        "OPTIONS /quick HTTP/1.1\r\nHost: a\r\n\r\n", "GET nothing HTTP/1.1\r\nHost: a\r\n\r\n",
        "GET /quick HTTP/1.1\r\n\r\n", "?\r\n\r\n", "GET /missing HTTP/1.1\r\nHost: a\r\n\r\n"}) {
    const test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {},
                                   {.request_rate = 1});
    const auto ask = [&] {
      test::HttpClient client(server.port());
      client.send(request);
      return client.receive();
    };
    int answered = 0;
    test::HttpAnswer answer = ask();
    for (; answer.status != 429 && answered < 1000; answer = ask())
      ++answered;
    EXPECT_GE(answered, 10) << request;
    EXPECT_EQ(answer.status, 429) << request;
    EXPECT_EQ(answer.field("retry-after"), "1") << request;
    EXPECT_EQ(test::http_get(server.port(), "/quick").status, 200) << request;
  }
}

// A visitor who needs many chunks must get them all, but must not fill the disk with log lines.
TEST(Overload, AnswersFromMemoryBeyondTheRateAreSentButNotLogged) {
  constexpr int kCalls = 2000;
  test::LocalServer server(kCrowdedRoutes, std::chrono::seconds(30), {}, {.request_rate = 10});
  test::HttpClient client(server.port());
  for (int i = 0; i < kCalls; ++i)
    EXPECT_EQ(client.get("/quick").status, 200);
  EXPECT_GT(server.metrics().answers_not_logged.load(), 0u);
  EXPECT_LE(server.metrics().answers_not_logged.load(), kCalls - 100u);
}

TEST(Overload, RefusedChangesAreAuditedByTheRationAndOthersAlways) {
  constexpr int kCalls = 2000;
  test::LocalServer server(kCrowdedRoutes);
  test::HttpClient client(server.port());
  for (int i = 0; i < kCalls; ++i)
    EXPECT_EQ(client.get("/locked", "Content-Length: 0\r\n", "POST").status, 401);
  const std::string who = server.bearer(Role::kOperator) + "Content-Length: 0\r\n";
  EXPECT_EQ(client.get("/locked", who, "POST").status, 200);
  EXPECT_EQ(client.get("/quick", "Content-Length: 0\r\n", "POST").status, 200);
  EXPECT_EQ(client.get("/quick").status, 200);
  const std::string lines = server.events();
  const auto audited = std::ranges::count(lines, '\n') - 1;
  EXPECT_GE(audited, 100);
  EXPECT_LT(audited, kCalls / 2);
  EXPECT_EQ(server.metrics().refusals_not_logged.load(),
            kCalls - static_cast<std::uint64_t>(audited));
  EXPECT_NE(lines.find("target=/locked status=200\n"), std::string::npos);
  EXPECT_EQ(lines.find("target=/quick"), std::string::npos) << "everybody may do this";
}

TEST(Overload, AnEmergencyStopGetsThroughHoweverOftenItsCallerHasCalled) {
  test::FakeScanner world;
  std::vector<std::unique_ptr<ScannerBackend>> scanners;
  scanners.push_back(std::make_unique<test::FakeBackend>(world));
  test::LocalServer server(public_routes(), std::chrono::seconds(30), std::move(scanners),
                           {.request_rate = 1});
  ASSERT_TRUE(server.scans().start());
  const std::string who = server.bearer(Role::kOperator) + "Content-Length: 0\r\n";
  test::HttpClient client(server.port());
  while (client.get("/api/v1/scanners/rig", who).status == 200) {
  }
  EXPECT_EQ(client.get("/api/v1/scanners/rig/stop", who, "POST").status, 200);
  EXPECT_TRUE(world.stopped());
}

}  // namespace
}  // namespace vitrine::server
