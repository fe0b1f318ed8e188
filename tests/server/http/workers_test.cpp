// SPDX-License-Identifier: Apache-2.0
#include "server/http/workers.h"

#include <gtest/gtest.h>

#include <future>
#include <semaphore>
#include <vector>

namespace vitrine::server {
namespace {

TEST(Workers, OneAddressHasAQuarterOfTheSeatsForDevicesAndForTheDisk) {
  Workers workers({});
  for (const Executor where : {Executor::kDevice, Executor::kDisk}) {
    std::vector<AdmissionLimit::Pass> taken;
    auto last = workers.admit(where, "a");
    for (; last; last = workers.admit(where, "a"))
      taken.push_back(*last);
    EXPECT_EQ(last.error(), AdmissionLimit::Refusal::kAddressFull);
    const std::size_t quarter = taken.size();
    for (const char* other : {"b", "c"}) {
      for (std::size_t i = 0; i < quarter; ++i)
        taken.push_back(workers.admit(where, other).value());
    }
    EXPECT_TRUE(workers.admit(where, "d"));
  }
}

TEST(Workers, ChecksRunWhileRequestsOccupyAllOtherThreads) {
  constexpr int kThreads = 2;
  Workers workers({.threads = kThreads});
  std::counting_semaphore<> may_end(0);
  for (const Executor where : {Executor::kWorker, Executor::kCompute, Executor::kDevice,
                               Executor::kDisk, Executor::kUrgent}) {
    for (int i = 0; i < 2 * kThreads; ++i)
      asio::post(workers.executor(where), [&] { may_end.acquire(); });
  }
  std::promise<void> checked;
  asio::post(workers.checks(), [&] { checked.set_value(); });
  checked.get_future().wait();
  may_end.release(5 * 2 * kThreads);
  workers.join();
}

TEST(Workers, ANetworkWithManySlowLookupsOfTokensDelaysNoLookupOfAnother) {
  asio::io_context io;
  Workers workers({});
  std::counting_semaphore<> may_end(0);
  const auto look_up = [&](const char* network, std::function<void()> task) {
    asio::co_spawn(asio::make_strand(io), workers.look_up_token(network, std::move(task)),
                   asio::detached);
  };
  constexpr int kSlow = 8;
  for (int i = 0; i < kSlow; ++i)
    look_up("a", [&] { may_end.acquire(); });
  look_up("b", [&] { may_end.release(kSlow); });
  io.run();
  workers.stop();
  workers.join();
}

TEST(Workers, AComputationThatNobodyWaitsForHasATurn) {
  asio::io_context io;
  Workers workers({});
  int done = 0;
  for (const char* model : {"a", "b", "a"})
    workers.compute(io, "posters", model, [&] { ++done; });
  io.run();
  EXPECT_EQ(done, 3);
  workers.stop();
  workers.join();
}

}  // namespace
}  // namespace vitrine::server
