// SPDX-License-Identifier: Apache-2.0
#include "server/http/workers.h"

namespace vitrine::server {
namespace {

// Returns an admission limit that lets one address use at most a quarter of the capacity, so that
// no address can lock out the others.
std::shared_ptr<AdmissionLimit> shared_limit(std::size_t capacity) {
  return std::make_shared<AdmissionLimit>(capacity, (capacity + 3) / 4);
}

}  // namespace

Workers::Workers(WorkerOptions options)
    : pool_(options.threads + options.waiting_threads),
      computations_(options.threads),
      turns_(std::make_shared<FairTurns>(options.threads)),
      computation_limit_(shared_limit(options.max_computations)) {}

void Workers::stop() {
  turns_->stop();
  for (asio::thread_pool* pool : {&pool_, &computations_, &devices_, &disk_})
    pool->stop();
}

asio::any_io_executor Workers::executor(Executor where) {
  if (where == Executor::kDevice) return devices_.executor();
  if (where == Executor::kDisk) return disk_.executor();
  if (where == Executor::kCompute) return computations_.executor();
  return pool_.executor();
}

tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> Workers::admit(
    Executor where, const std::string& address) {
  // the limit on connections also bounds these tasks
  if (where == Executor::kWorker) return nullptr;
  if (where == Executor::kCompute) return computation_limit_->admit(address);
  return (where == Executor::kDevice ? device_limit_ : disk_limit_)->admit(address);
}

}  // namespace vitrine::server
