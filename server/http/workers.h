// SPDX-License-Identifier: Apache-2.0
// Worker threads for handlers that would block the connections' threads.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>

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
  unsigned waiting_threads = 0;  // additional threads for handlers that wait for other daemons
  unsigned urgent_threads = 1;   // number of threads for Executor::kUrgent
  // Largest number of computations that run or wait. A running computation may hold a decoded mesh.
  std::size_t max_computations = 64;
};

class Workers {
 public:
  explicit Workers(WorkerOptions options);

  // Admits one task for `address`, which is a result of network_of(). The caller must keep the pass
  // until the task is done.
  tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> admit(Executor where,
                                                                    const std::string& address);

  // Runs `task` on a thread for `where`, and returns its result. `owner` is the client's token, or
  // its network (network_of()) if it has none. On kWorker and kCompute, owners take turns: on
  // kWorker an owner has at most a quarter of the threads, on kCompute tasks with equal targets run
  // one after the other. Must be called on a strand.
  template <class Task>
  asio::awaitable<std::invoke_result_t<const Task&>> run(Executor where, std::string owner,
                                                         std::string target, const Task& task) {
    const FairTurns::Turn turn = co_await turn_on(where, std::move(owner), std::move(target));
    co_return co_await run_on(executor(where), task);
  }

  // Runs `task`, which looks up a token, on threads that only look up tokens. Owners take turns,
  // and each has one thread at most. Must be called on a strand.
  asio::awaitable<void> look_up_token(std::string owner, std::function<void()> task);

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
  // Runs `task` on the executor and returns its result.
  template <class Task>
  static asio::awaitable<std::invoke_result_t<const Task&>> run_on(asio::any_io_executor threads,
                                                                   const Task& task) {
    auto work = [&]() -> asio::awaitable<std::invoke_result_t<const Task&>> { co_return task(); };
    co_return co_await asio::co_spawn(std::move(threads), work, asio::use_awaitable);
  }
  // Waits until a task of `owner` may run on `where`.
  asio::awaitable<FairTurns::Turn> turn_on(Executor where, std::string owner, std::string target);
  auto pools() {
    return std::array{&pool_,   &computations_, &devices_, &disk_,
                      &checks_, &openings_,     &lookups_, &urgent_};
  }

  static constexpr std::size_t kDeviceThreads = 4, kMaxDeviceTasks = 32;
  static constexpr std::size_t kDiskThreads = 4, kMaxDiskTasks = 64;
  // The number of threads that open files is large, because they often wait for a disk or an S3
  // bucket.
  static constexpr std::size_t kOpeningThreads = 8;
  static constexpr std::size_t kLookupThreads = 4;

  asio::thread_pool pool_;
  asio::thread_pool computations_;
  asio::thread_pool devices_{kDeviceThreads};
  asio::thread_pool disk_{kDiskThreads};
  asio::thread_pool checks_{1};
  asio::thread_pool openings_{kOpeningThreads};
  asio::thread_pool lookups_{kLookupThreads};
  asio::thread_pool urgent_;
  // These queues assign the threads of pool_, computations_, openings_ and lookups_ to tasks.
  const std::shared_ptr<FairTurns> worker_turns_, computing_turns_;
  const std::shared_ptr<FairTurns> opening_turns_ = std::make_shared<FairTurns>(kOpeningThreads);
  const std::shared_ptr<FairTurns> lookup_turns_ = std::make_shared<FairTurns>(kLookupThreads, 1);
  SharedFailures failures_;
  const std::shared_ptr<AdmissionLimit> computation_limit_, device_limit_, disk_limit_;
};

}  // namespace vitrine::server
