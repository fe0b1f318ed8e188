// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/safe_board.h"

#include <fmt/format.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace vitrine::acquisition {
namespace {

using Clock = std::chrono::steady_clock;

class SafeBoard final : public Board {
 public:
  SafeBoard(OpenedController opened, BoardIdentity identity, const BoardOptions& options,
            Guardian guardian)
      : guardian_(std::move(guardian)),
        port_(std::move(opened.port)),
        controller_(std::move(opened.controller)),
        identity_(std::move(identity)),
        watchdog_timeout_(options.watchdog),
        power_(options.power) {}
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
  // Runs `call` and feeds the watchdog. Switches laser and motor off if `call` fails. Does not run
  // `call` if the board has failed before.
  template <class Call>
  auto guarded(Call call) -> decltype(call());
  template <class T>
  Expected<T> judged(Expected<T> result);
  // Records that the table turns while `motion` runs.
  template <class Motion>
  Expected<void> moved(Motion motion);
  void switch_off();
  void halt() noexcept;
  void lose_guardian();
  void watch();

  Guardian guardian_;  // declared first, so destroyed last
  std::unique_ptr<SerialPort> port_;
  std::unique_ptr<Controller> controller_;
  BoardIdentity identity_;
  std::chrono::milliseconds watchdog_timeout_;
  std::shared_ptr<PowerRecord> power_;
  std::atomic<bool> is_stopped_{false};

  std::mutex mutex_;  // guards the members below, and all calls of controller_ except halt()
  std::condition_variable closing_soon_;
  bool is_off_ = false;  // whether the board has confirmed the last switch-off
  std::optional<Error> failure_;
  Clock::time_point last_call_ = Clock::now();
  bool is_resting_ = true, is_closing_ = false;
  std::thread watchdog_;
};

Expected<void> SafeBoard::start() {
  auto firmware = controller_->greet();
  if (!firmware) {
    if (firmware.error().code == ErrorCode::kIo) switch_off();
    // Nothing is switched on yet. A guardian that kept running would disturb the next attempt to
    // open the board.
    guardian_.dismiss();
    return tl::unexpected(firmware.error());
  }
  identity_.firmware = *firmware;
  if (auto off = controller_->switch_off(); !off) {
    controller_->halt();
    guardian_.dismiss();
    return off;
  }
  power_->both_off();
  watchdog_ = std::thread([this] { watch(); });
  return {};
}

void SafeBoard::switch_off() {
  is_off_ = controller_->switch_off().has_value();
  if (is_off_) return power_->both_off();
  power_->unknown();
  controller_->halt();
}

// Counts the board as off if the command could be sent, because the firmware obeys this command
// even if it sends no confirmation.
void SafeBoard::halt() noexcept {
  if (controller_->halt()) return power_->both_off();
  power_->unknown();
}

void SafeBoard::lose_guardian() {
  switch_off();
  failure_ = Error{ErrorCode::kIo, port_->name() +
                                       " was switched off because the process that guards its "
                                       "laser has ended; open the scanner again to continue"};
}

template <class T>
Expected<T> SafeBoard::judged(Expected<T> result) {
  if (is_stopped_) {
    halt();  // `call` may have switched something on after emergency_stop()
    return fail(ErrorCode::kState,
                port_->name() + " was stopped in an emergency; open the scanner again to continue");
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
  if (failure_) return judged(decltype(call())(tl::unexpected(*failure_)));
  auto result = judged(is_stopped_ ? decltype(call())() : call());
  last_call_ = Clock::now();
  is_resting_ = false;
  return result;
}

template <class Motion>
Expected<void> SafeBoard::moved(Motion motion) {
  power_->motor(MotorState::kTurning);
  auto done = motion();
  if (done) power_->motor(MotorState::kHolding);
  return done;
}

Expected<std::optional<double>> SafeBoard::position() {
  return guarded([this] { return controller_->position(); });
}

Expected<void> SafeBoard::set_position(double degrees) {
  if (degrees == 0) return guarded([&] { return controller_->set_position(degrees); });
  return guarded([&] { return moved([&] { return controller_->set_position(degrees); }); });
}

Expected<void> SafeBoard::turn_to(double degrees) {
  return guarded([&] { return moved([&] { return controller_->turn_to(degrees); }); });
}

Expected<void> SafeBoard::laser(bool on) {
  return guarded([&] {
    if (on) power_->laser(LaserState::kOn);
    auto done = controller_->laser(on);
    if (done && !on) power_->laser(LaserState::kOff);
    return done;
  });
}

Expected<void> SafeBoard::rest() {
  auto off = guarded([this] {
    auto done = controller_->switch_off();
    if (done) power_->both_off();
    return done;
  });
  const std::lock_guard lock(mutex_);
  is_resting_ = true;
  return off;
}

void SafeBoard::emergency_stop() noexcept {
  is_stopped_ = true;
  halt();
  port_->cancel();
}

// Waits in a thread of its own. Switches laser and motor off if the caller makes no call within the
// watchdog's timeout. Later calls fail, because laser and table are no longer in the state that the
// caller expects.
void SafeBoard::watch() {
  std::unique_lock lock(mutex_);
  while (!is_closing_) {
    const bool idle = is_resting_ || failure_ || is_stopped_;
    const auto deadline = last_call_ + watchdog_timeout_;
    if (!idle && Clock::now() >= deadline) {
      switch_off();
      failure_ =
          Error{ErrorCode::kIo,
                fmt::format("{} was switched off because no call came for {} ms; open the scanner "
                            "again to continue",
                            port_->name(), watchdog_timeout_.count())};
    } else if (idle) {
      closing_soon_.wait_for(lock, watchdog_timeout_);
    } else {
      closing_soon_.wait_until(lock, deadline);
    }
  }
}

SafeBoard::~SafeBoard() {
  if (watchdog_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      is_closing_ = true;
      closing_soon_.notify_all();
    }
    watchdog_.join();
    if (!is_stopped_ && !failure_) switch_off();
  }
  // Dismisses the guardian only if the board has confirmed that it is off. A guardian that is not
  // dismissed switches the board off.
  if (is_off_ && !is_stopped_) guardian_.dismiss();
}

}  // namespace

Expected<std::unique_ptr<Board>> make_safe(OpenedController opened, BoardIdentity identity,
                                           const BoardOptions& options, Guardian guardian) {
  auto board = std::make_unique<SafeBoard>(std::move(opened), std::move(identity), options,
                                           std::move(guardian));
  if (auto started = board->start(); !started) return tl::unexpected(started.error());
  return board;
}

}  // namespace vitrine::acquisition
