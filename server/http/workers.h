// SPDX-License-Identifier: Apache-2.0
// Worker threads for handlers that would block the connections' threads.
#pragma once

#include <memory>
#include <string>

#include "server/http/admission_limit.h"
#include "server/http/beast.h"
#include "server/http/fair_turns.h"
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

  asio::any_io_executor executor(Executor where);  // returns the executor for a task
  void stop();
  void join() { pool_.join(), computations_.join(), devices_.join(), disk_.join(); }

 private:
  static constexpr std::size_t kDeviceThreads = 4, kMaxDeviceTasks = 32;
  static constexpr std::size_t kDiskThreads = 4, kMaxDiskTasks = 64;

  asio::thread_pool pool_;
  asio::thread_pool computations_;
  asio::thread_pool devices_{kDeviceThreads};
  asio::thread_pool disk_{kDiskThreads};
  const std::shared_ptr<FairTurns> turns_;  // turns on the threads of computations_
  const std::shared_ptr<AdmissionLimit> computation_limit_;  // one address gets at most a quarter
  const std::shared_ptr<AdmissionLimit> device_limit_ =
      std::make_shared<AdmissionLimit>(kMaxDeviceTasks, kMaxDeviceTasks);
  const std::shared_ptr<AdmissionLimit> disk_limit_ =
      std::make_shared<AdmissionLimit>(kMaxDiskTasks, kMaxDiskTasks);
};

}  // namespace vitrine::server
