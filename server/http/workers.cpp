// SPDX-License-Identifier: Apache-2.0
#include "server/http/workers.h"

namespace vitrine::server {
namespace {

// Returns an admission limit that lets one address use at most a quarter of the capacity, so that
// no address can lock out other addresses.
std::shared_ptr<AdmissionLimit> shared_limit(std::size_t capacity) {
  return std::make_shared<AdmissionLimit>(capacity, (capacity + 3) / 4);
}

}  // namespace

Workers::Workers(WorkerOptions options)
    : pool_(options.threads + options.waiting_threads),
      computations_(options.threads),
      turns_(std::make_shared<FairTurns>(options.threads)),
      computation_limit_(shared_limit(options.max_computations)),
      device_limit_(shared_limit(kMaxDeviceTasks)),
      disk_limit_(shared_limit(kMaxDiskTasks)) {}

void Workers::stop() {
  turns_->stop();
  opening_turns_->stop();
  for (asio::thread_pool* pool : {&pool_, &computations_, &devices_, &disk_, &checks_, &openings_})
    pool->stop();
}

void Workers::join() {
  for (asio::thread_pool* pool : {&pool_, &computations_, &devices_, &disk_, &checks_, &openings_})
    pool->join();
}

asio::awaitable<void> Workers::open(std::string owner, Opening opening) {
  const auto has_failed = failures_.join(opening.name);
  const FairTurns::Turn turn = co_await opening_turns_->wait(std::move(owner), opening.name);
  if (*has_failed) co_return;  // the handler reports the fault
  auto work = [&]() -> asio::awaitable<void> {
    bool is_open = false;
    try {
      is_open = opening.open();
    } catch (const std::exception&) {  // the handler opens the file again, and reports the fault
    }
    if (!is_open) failures_.fail(opening.name);
    co_return;
  };
  co_await asio::co_spawn(openings_.executor(), work, asio::use_awaitable);
}

void Workers::compute(asio::io_context& io, std::string owner, std::string target,
                      std::function<void()> task) {
  auto in_turn = [this, owner = std::move(owner), target = std::move(target),
                  task = std::move(task)]() -> asio::awaitable<void> {
    const FairTurns::Turn turn = co_await computing_turn(owner, target);
    auto run = [&]() -> asio::awaitable<void> {
      task();
      co_return;
    };
    co_await asio::co_spawn(executor(Executor::kCompute), run, asio::use_awaitable);
  };
  asio::co_spawn(asio::make_strand(io), std::move(in_turn), asio::detached);
}

asio::any_io_executor Workers::executor(Executor where) {
  if (where == Executor::kDevice) return devices_.executor();
  if (where == Executor::kDisk) return disk_.executor();
  if (where == Executor::kCompute) return computations_.executor();
  return pool_.executor();
}

tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> Workers::admit(
    Executor where, const std::string& address) {
  // Each of these tasks has its own connection, so the limit on connections also limits the tasks.
  if (where == Executor::kWorker) return nullptr;
  if (where == Executor::kCompute) return computation_limit_->admit(address);
  return (where == Executor::kDevice ? device_limit_ : disk_limit_)->admit(address);
}

}  // namespace vitrine::server
