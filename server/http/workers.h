// SPDX-License-Identifier: Apache-2.0
// Worker threads for handlers that would block the connections' threads.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/admission_limit.h"
#include "server/http/beast.h"
#include "server/http/fair_turns.h"
#include "server/http/shared_failures.h"
#include "server/messages/router.h"

namespace vitrine::server {

struct WorkerOptions {
  // Number of threads for Executor::kWorker. Executor::kCompute has the same number of separate
  // threads.
  unsigned threads = 1;
  unsigned waiting_threads = 0;       // additional threads for handlers that wait for other daemons
  std::size_t max_computations = 64;  // largest number of computations that run or wait
};

class Workers {
 public:
  explicit Workers(WorkerOptions options);

  // Admits one task for `address`, which is a result of network_of(). The caller must keep the pass
  // until the task is done.
  tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> admit(Executor where,
                                                                    const std::string& address);

  // Waits until a computation of `owner` may run on the executor for Executor::kCompute; see
  // FairTurns.
  asio::awaitable<FairTurns::Turn> computing_turn(std::string owner, std::string target) {
    return turns_->wait(std::move(owner), std::move(target));
  }

  // Opens a file for a request of `owner`, on threads that only open files. Owners take turns.
  // Requests for the same file also take turns, so that only the first one has to open it. If the
  // file cannot be opened, the requests that wait for it at that moment do not try it again. An
  // exception of Opening::open counts as a failure. Must be called on a strand.
  asio::awaitable<void> open(std::string owner, Opening opening);

  // Runs `task` when it is the turn of `owner` to compute. Does not wait for the result, and
  // ignores exceptions of `task`.
  void compute(asio::io_context& io, std::string owner, std::string target,
               std::function<void()> task);

  asio::any_io_executor executor(Executor where);  // returns the executor for a task
  // Returns the executor for the server's own periodic checks. They have a thread of their own,
  // because requests can occupy all other workers for minutes, for example to open large models.
  asio::any_io_executor checks() { return checks_.executor(); }
  void stop();
  void join();

 private:
  static constexpr std::size_t kDeviceThreads = 4, kMaxDeviceTasks = 32;
  static constexpr std::size_t kDiskThreads = 4, kMaxDiskTasks = 64;
  // The number of opening threads is large, because they often wait for a disk or a bucket.
  static constexpr std::size_t kOpeningThreads = 8;

  asio::thread_pool pool_;
  asio::thread_pool computations_;
  asio::thread_pool devices_{kDeviceThreads};
  asio::thread_pool disk_{kDiskThreads};
  asio::thread_pool checks_{1};
  asio::thread_pool openings_{kOpeningThreads};
  const std::shared_ptr<FairTurns> turns_;  // turns on the threads of computations_
  const std::shared_ptr<FairTurns> opening_turns_ = std::make_shared<FairTurns>(kOpeningThreads);
  SharedFailures failures_;
  const std::shared_ptr<AdmissionLimit> computation_limit_, device_limit_, disk_limit_;
};

}  // namespace vitrine::server
