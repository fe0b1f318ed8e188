// SPDX-License-Identifier: Apache-2.0
#include "server/http/workers.h"

namespace vitrine::server {
namespace {

// Returns a quarter of a capacity, rounded up. One address or owner may use only this share, so
// that it cannot lock out others.
constexpr std::size_t quarter(std::size_t capacity) {
  return (capacity + 3) / 4;
}

std::shared_ptr<AdmissionLimit> shared_limit(std::size_t capacity) {
  return std::make_shared<AdmissionLimit>(capacity, quarter(capacity));
}

std::shared_ptr<FairTurns> shared_turns(std::size_t threads) {
  return std::make_shared<FairTurns>(threads, quarter(threads));
}

}  // namespace

Workers::Workers(WorkerOptions options)
    : pool_(options.threads + options.waiting_threads),
      computations_(options.threads),
      urgent_(options.urgent_threads),
      worker_turns_(shared_turns(options.threads + options.waiting_threads)),
      computing_turns_(std::make_shared<FairTurns>(options.threads)),
      computation_limit_(shared_limit(options.max_computations)),
      device_limit_(shared_limit(kMaxDeviceTasks)),
      disk_limit_(shared_limit(kMaxDiskTasks)) {}

void Workers::stop() {
  for (const auto& turns : {worker_turns_, computing_turns_, opening_turns_, lookup_turns_})
    turns->stop();
  for (asio::thread_pool* pool : pools())
    pool->stop();
}

void Workers::join() {
  for (asio::thread_pool* pool : pools())
    pool->join();
}

asio::awaitable<void> Workers::open(std::string owner, Opening opening) {
  const auto has_failed = failures_.join(opening.name);
  const FairTurns::Turn turn = co_await opening_turns_->wait(std::move(owner), opening.name);
  if (*has_failed) co_return;  // the handler reports the fault
  co_await run_on(openings_.executor(), [&] {
    bool is_open = false;
    try {
      is_open = opening.open();
    } catch (const std::exception&) {  // the handler opens the file again, and reports the fault
    }
    if (!is_open) failures_.fail(opening.name);
  });
}

asio::awaitable<void> Workers::look_up_token(std::string owner, std::function<void()> task) {
  const FairTurns::Turn turn = co_await lookup_turns_->wait(std::move(owner));
  co_await run_on(lookups_.executor(), task);
}

void Workers::compute(asio::io_context& io, std::string owner, std::string target,
                      std::function<void()> task) {
  auto in_turn = [this, owner = std::move(owner), target = std::move(target),
                  task = std::move(task)]() -> asio::awaitable<void> {
    co_await run(Executor::kCompute, owner, target, task);
  };
  asio::co_spawn(asio::make_strand(io), std::move(in_turn), asio::detached);
}

asio::awaitable<FairTurns::Turn> Workers::turn_on(Executor where, std::string owner,
                                                  std::string target) {
  if (where == Executor::kWorker) co_return co_await worker_turns_->wait(std::move(owner));
  if (where == Executor::kCompute)
    co_return co_await computing_turns_->wait(std::move(owner), std::move(target));
  co_return nullptr;
}

asio::any_io_executor Workers::executor(Executor where) {
  if (where == Executor::kDevice) return devices_.executor();
  if (where == Executor::kDisk) return disk_.executor();
  if (where == Executor::kCompute) return computations_.executor();
  if (where == Executor::kUrgent) return urgent_.executor();
  return pool_.executor();
}

tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> Workers::admit(
    Executor where, const std::string& address) {
  // Each of these tasks has its own connection, so the limit on connections also limits the tasks.
  if (where == Executor::kWorker || where == Executor::kUrgent) return nullptr;
  if (where == Executor::kCompute) return computation_limit_->admit(address);
  return (where == Executor::kDevice ? device_limit_ : disk_limit_)->admit(address);
}

}  // namespace vitrine::server
