// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/safe_board.h"

#include <fmt/format.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace vitrine {
namespace {

using Clock = std::chrono::steady_clock;

class SafeBoard final : public Board {
 public:
  SafeBoard(OpenedController opened, BoardIdentity identity, std::chrono::milliseconds watchdog,
            Guardian guardian)
      : guardian_(std::move(guardian)),
        port_(std::move(opened.port)),
        controller_(std::move(opened.controller)),
        identity_(std::move(identity)),
        patience_(watchdog) {}
  ~SafeBoard() override;

  Expected<void> start();

  const BoardIdentity& identity() const override { return identity_; }
  Expected<std::optional<double>> position() override;
  Expected<void> set_position(double degrees) override;
  Expected<void> turn_to(double degrees) override;
  Expected<void> laser(bool on) override;
  Expected<void> rest() override;
  void emergency_stop() noexcept override;

 private:
  // Runs `call` unless the board has failed, switches off where it fails, and feeds the watchdog.
  template <class Call>
  auto guarded(Call call) -> decltype(call());
  template <class T>
  Expected<T> judged(Expected<T> result);
  void switch_off();
  void lose_guardian();
  void watch();

  Guardian guardian_;  // ends last
  std::unique_ptr<SerialPort> port_;
  std::unique_ptr<Controller> controller_;
  BoardIdentity identity_;
  std::chrono::milliseconds patience_;
  std::atomic<bool> stopped_{false};

  std::mutex mutex_;  // what follows, and controller_ but for halt()
  std::condition_variable closing_soon_;
  bool is_off_ = false;  // as the board confirmed when it was switched off last
  std::optional<Error> failure_;
  Clock::time_point last_call_ = Clock::now();
  bool resting_ = true, closing_ = false;
  std::thread watchdog_;
};

Expected<void> SafeBoard::start() {
  auto firmware = controller_->greet();
  if (!firmware) {
    if (firmware.error().code == ErrorCode::kIo) switch_off();
    guardian_.dismiss();  // nothing has been switched on, and it would be in the next try's way
    return Unexpected(std::move(firmware).error());
  }
  identity_.firmware = *firmware;
  if (auto off = controller_->switch_off(); !off) {
    controller_->halt();
    guardian_.dismiss();
    return off;
  }
  watchdog_ = std::thread([this] { watch(); });
  return {};
}

void SafeBoard::switch_off() {
  is_off_ = controller_->switch_off().has_value();
  if (!is_off_) controller_->halt();
}

void SafeBoard::lose_guardian() {
  switch_off();
  failure_ = Error{ErrorCode::kIo, port_->name() +
                                       " was switched off, the process that guards its laser has "
                                       "ended; open the scanner anew to go on"};
}

template <class T>
Expected<T> SafeBoard::judged(Expected<T> result) {
  if (stopped_) {
    controller_->halt();  // the call may have switched something on since emergency_stop() halted
    return fail(ErrorCode::kState,
                port_->name() + " was stopped in an emergency; open the scanner anew to go on");
  }
  if (!result && !failure_) {
    failure_ = result.error();
    switch_off();
  }
  return result;
}

template <class Call>
auto SafeBoard::guarded(Call call) -> decltype(call()) {
  const std::lock_guard lock(mutex_);
  if (!failure_ && !guardian_.is_there()) lose_guardian();
  if (failure_) return judged(decltype(call())(Unexpected(*failure_)));
  auto result = judged(stopped_ ? decltype(call())() : call());
  last_call_ = Clock::now();
  resting_ = false;
  return result;
}

Expected<std::optional<double>> SafeBoard::position() {
  return guarded([this] { return controller_->position(); });
}

Expected<void> SafeBoard::set_position(double degrees) {
  return guarded([&] { return controller_->set_position(degrees); });
}

Expected<void> SafeBoard::turn_to(double degrees) {
  return guarded([&] { return controller_->turn_to(degrees); });
}

Expected<void> SafeBoard::laser(bool on) {
  return guarded([&] { return controller_->laser(on); });
}

Expected<void> SafeBoard::rest() {
  auto off = guarded([this] { return controller_->switch_off(); });
  const std::lock_guard lock(mutex_);
  resting_ = true;
  return off;
}

void SafeBoard::emergency_stop() noexcept {
  stopped_ = true;
  controller_->halt();
  port_->cancel();
}

// A caller that is silent is taken for stuck; what it believes of laser and table is no longer
// true.
void SafeBoard::watch() {
  std::unique_lock lock(mutex_);
  while (!closing_) {
    const bool idle = resting_ || failure_ || stopped_;
    const auto deadline = last_call_ + patience_;
    if (!idle && Clock::now() >= deadline) {
      switch_off();
      failure_ = Error{ErrorCode::kIo,
                       fmt::format("{} was switched off, no call came for {} ms; open the scanner "
                                   "anew to go on",
                                   port_->name(), patience_.count())};
    } else if (idle) {
      closing_soon_.wait_for(lock, patience_);
    } else {
      closing_soon_.wait_until(lock, deadline);
    }
  }
}

SafeBoard::~SafeBoard() {
  if (watchdog_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
      closing_soon_.notify_all();
    }
    watchdog_.join();
    if (!stopped_ && !failure_) switch_off();
  }
  // Else it does what it would do if this process died.
  if (is_off_ && !stopped_) guardian_.dismiss();
}

}  // namespace

Expected<std::unique_ptr<Board>> make_safe(OpenedController opened, BoardIdentity identity,
                                           const BoardOptions& options, Guardian guardian) {
  auto board = std::make_unique<SafeBoard>(std::move(opened), std::move(identity), options.watchdog,
                                           std::move(guardian));
  if (auto started = board->start(); !started) return Unexpected(started.error());
  return board;
}

}  // namespace vitrine
