// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "acquisition/device/controller.h"
#include "acquisition/device/conversation.h"
#include "acquisition/device/fabscan.h"

namespace vitrine::acquisition {
namespace {

using std::chrono::milliseconds;

class FabScanController final : public Controller {
 public:
  FabScanController(SerialPort& port, milliseconds timeout, int steps_per_turn)
      : talk_(port, fabscan::kPrompt),
        name_(port.name()),
        timeout_(timeout),
        steps_per_degree_(steps_per_turn / 360.0) {}

  Expected<std::string> greet() override;
  Expected<std::optional<double>> position() override;
  Expected<void> set_position(double degrees) override;
  Expected<void> turn_to(double degrees) override;
  Expected<void> laser(bool on) override;
  Expected<void> switch_off() override;
  bool halt() noexcept override { return talk_.port().restart_controller().has_value(); }

 private:
  // Sends a command and returns the last line of the answer before the prompt. Returns an empty
  // text if the answer has no lines.
  Expected<std::string> command(const std::string& line, milliseconds timeout);
  Expected<void> obey(const std::string& line);
  Expected<void> step(long steps);
  long step_at(double degrees) const { return std::lround(degrees * steps_per_degree_); }

  Conversation talk_;
  std::string name_;
  milliseconds timeout_;
  double steps_per_degree_;
  long steps_ = 0;  // motor steps from 0 degrees; angles are rounded to the nearest step
  bool is_known_ = false, is_motor_on_ = false;
};

Expected<std::string> FabScanController::command(const std::string& line, milliseconds timeout) {
  const auto deadline = SerialPort::Clock::now() + timeout;
  if (auto said = talk_.say(line); !said) return tl::unexpected(said.error());
  std::string answer;
  bool is_echoed = false;
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return tl::unexpected(heard.error());
    if (!*heard)
      return fail(ErrorCode::kIo, fmt::format("{} does not answer '{}' in time; check the motor's "
                                              "power and that the table turns freely",
                                              name_, line));
    if (**heard == std::string(1, fabscan::kPrompt) && is_echoed) return answer;
    if (**heard == line)
      is_echoed = true;
    else if (is_echoed)
      answer = **heard;
    else
      return fail(
          ErrorCode::kIo,
          fmt::format("{} does not echo '{}'; check its cable and its firmware", name_, line));
  }
}

Expected<void> FabScanController::obey(const std::string& line) {
  return command(line, timeout_).map([](const std::string&) {});
}

// Repeats the query, because an Arduino that has just been plugged in is still starting up.
Expected<std::string> FabScanController::greet() {
  std::string heard;
  for (milliseconds asked{0}; asked < kBoot; asked += kAskAgain) {
    if (auto ignored = talk_.ignore_all(kQuiet); !ignored) return tl::unexpected(ignored.error());
    const auto version = command(fabscan::kAskVersion, kAskAgain);
    if (version && fabscan::is_version(*version)) return "FabScan " + *version;
    if (!version && version.error().code == ErrorCode::kState) return version;
    heard = version ? *version : version.error().message;
  }
  return fail(ErrorCode::kBadInput,
              fmt::format("{} is not a FabScan board ({}); check vendor, product "
                          "and dialect",
                          name_, heard));
}

Expected<std::optional<double>> FabScanController::position() {
  if (!is_known_) return std::nullopt;
  return static_cast<double>(steps_) / steps_per_degree_;
}

// Stores the nearest motor step, because a motion to `degrees` would end at that step. A resumed
// scan therefore gives the same result as an uninterrupted one.
Expected<void> FabScanController::set_position(double degrees) {
  steps_ = step_at(degrees);
  is_known_ = true;
  return {};
}

Expected<void> FabScanController::step(long steps) {
  const auto timeout = timeout_ + milliseconds(1000 * std::abs(steps) / fabscan::kStepsPerSecond);
  auto done = command(fabscan::turn(static_cast<int>(steps)), timeout);
  if (!done) return tl::unexpected(done.error());
  steps_ += steps;
  return {};
}

Expected<void> FabScanController::turn_to(double degrees) {
  if (!is_motor_on_) {
    if (auto on = obey(fabscan::kMotorOn); !on) return on;
    is_motor_on_ = true;
  }
  const long target = step_at(degrees);
  while (steps_ != target) {
    const long part = std::clamp<long>(target - steps_, -fabscan::kMostSteps, fabscan::kMostSteps);
    if (auto done = step(part); !done) return done;
  }
  return {};
}

Expected<void> FabScanController::laser(bool on) {
  return obey(on ? fabscan::kLaserOn : fabscan::kLaserOff);
}

Expected<void> FabScanController::switch_off() {
  is_motor_on_ = false;
  for (const char* line : {fabscan::kLaserOff, fabscan::kOtherLaserOff, fabscan::kMotorOff})
    if (auto done = obey(line); !done) return done;
  return {};
}

}  // namespace

std::unique_ptr<Controller> make_fabscan(SerialPort& port, milliseconds timeout,
                                         int steps_per_turn) {
  return std::make_unique<FabScanController>(port, timeout, steps_per_turn);
}

}  // namespace vitrine::acquisition
