// SPDX-License-Identifier: Apache-2.0
// Sends commands to a board in the board's dialect. SafeBoard adds the watchdog, the guardian
// process and switching off after errors.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/device/board.h"
#include "acquisition/device/serial_port.h"

namespace vitrine::acquisition {

// kBoot is the timeout of the first greeting, which includes the two seconds that an Arduino's boot
// loader may take. kAskAgain is the interval at which the greeting is repeated.
inline constexpr std::chrono::milliseconds kBoot{5'000}, kAskAgain{700};
// If the board is silent for this long, its output counts as complete.
inline constexpr std::chrono::milliseconds kQuiet{50};

class Controller {
 public:
  virtual ~Controller() = default;

  // Identifies the board and returns its banner. Must be called first. Fails with kBadInput if the
  // board does not speak the dialect.
  virtual Expected<std::string> greet() = 0;

  // These functions have the same contracts as the functions of the same names in Board.
  virtual Expected<std::optional<double>> position() = 0;
  virtual Expected<void> set_position(double degrees) = 0;
  virtual Expected<void> turn_to(double degrees) = 0;
  virtual Expected<void> laser(bool on) = 0;

  // Switches laser and motor off and waits for the board's confirmation. Also works before greet().
  virtual Expected<void> switch_off() = 0;
  // Switches laser and motor off at once, whatever the board is doing, without confirmation.
  // Callable from any thread. Returns whether the command could be sent.
  virtual bool halt() noexcept = 0;
};

std::unique_ptr<Controller> make_horus(SerialPort& port, std::chrono::milliseconds timeout);
std::unique_ptr<Controller> make_fabscan(SerialPort& port, std::chrono::milliseconds timeout,
                                         int steps_per_turn);

struct OpenedController {
  std::unique_ptr<SerialPort> port;
  std::unique_ptr<Controller> controller;  // communicates through `port`
};
// Opens the port and returns a controller for it. The caller must call greet() next.
Expected<OpenedController> open_controller(const BoardSelector& selector,
                                           std::chrono::milliseconds timeout);

}  // namespace vitrine::acquisition
