// SPDX-License-Identifier: Apache-2.0
// A board in one dialect, without what makes it safe (SafeBoard).
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/device/board.h"
#include "acquisition/device/serial_port.h"

namespace vitrine {

class Controller {
 public:
  virtual ~Controller() = default;

  // To be called first: who it is. Fails with kBadInput where it is of another kind.
  virtual Expected<std::string> greet() = 0;

  // As of Board.
  virtual Expected<std::optional<double>> position() = 0;
  virtual Expected<void> set_position(double degrees) = 0;
  virtual Expected<void> turn_to(double degrees) = 0;
  virtual Expected<void> laser(bool on) = 0;

  // Laser and motor off, confirmed. Possible without greet(), too.
  virtual Expected<void> switch_off() = 0;
  // Laser and motor off at once, not confirmed, whatever it is at. From any thread.
  virtual void halt() noexcept = 0;
};

std::unique_ptr<Controller> make_horus(SerialPort& port, std::chrono::milliseconds patience);
std::unique_ptr<Controller> make_fabscan(SerialPort& port, std::chrono::milliseconds patience,
                                         int steps_per_turn);

struct OpenedController {
  std::unique_ptr<SerialPort> port;
  std::unique_ptr<Controller> controller;  // speaks through `port`
};
// Not greeted.
Expected<OpenedController> open_controller(const BoardSelector& selector,
                                           std::chrono::milliseconds patience);

}  // namespace vitrine
