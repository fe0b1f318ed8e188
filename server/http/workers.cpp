// SPDX-License-Identifier: Apache-2.0
#include "server/http/workers.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kSerialExecutors = 16;

// Returns an admission limit of which one address may use at most a quarter, so that no address can
// lock out the others.
std::shared_ptr<AdmissionLimit> shared_limit(std::size_t capacity) {
  return std::make_shared<AdmissionLimit>(capacity, (capacity + 3) / 4);
}

}  // namespace

Workers::Workers(WorkerOptions options)
    : pool_(options.threads + options.waiting_threads),
      computations_(options.threads),
      computation_limit_(shared_limit(options.max_computations)) {
  for (std::size_t i = 0; i < kSerialExecutors; ++i)
    serial_.push_back(asio::make_strand(computations_.executor()));
}

asio::any_io_executor Workers::executor(Executor where, std::string_view target) {
  if (where == Executor::kDevice) return devices_.executor();
  if (where == Executor::kDisk) return disk_.executor();
  if (where != Executor::kCompute) return pool_.executor();
  return serial_[std::hash<std::string_view>{}(target) % kSerialExecutors];
}

tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> Workers::admit(
    Executor where, const std::string& address) {
  if (where == Executor::kWorker) return nullptr;  // the number of connections is the limit
  if (where == Executor::kCompute) return computation_limit_->admit(address);
  return (where == Executor::kDevice ? device_limit_ : disk_limit_)->admit(address);
}

}  // namespace vitrine::server
