// SPDX-License-Identifier: Apache-2.0
// Simulates a controller board as a USB device. Unmodified libusb programs find the device if they
// are started as children with environment(). The simulation answers the kernel's usbfs calls
// through umockdev.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/rig_board/firmware.h"
#include "acquisition/rig_board/usb_wire.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

struct UsbBoardSettings {
  bool is_fabscan = false;  // whether the firmware is FabScan instead of Horus
  UsbTransport transport = UsbTransport::kCdcAcm;
  std::string serial = "RIG0001";
  FirmwareSettings firmware;
};

// Functions that the board calls from its own threads, one at a time. They must not call the board.
struct UsbBoardEvents {
  // Receives the target of a motion, in degrees, before the motion starts.
  std::function<void(double degrees)> on_goal = [](double) {};
  // Receives the table's angle, in degrees, during the motion.
  std::function<void(double degrees)> on_move = [](double) {};
  // Receives the table's angle, in degrees, at the end of the motion.
  std::function<void(double degrees)> on_turn = [](double) {};
  std::function<void(bool on)> on_laser = [](bool) {}, on_motor = [](bool) {};
  // Receives each command to the board, and when its process submitted it.
  std::function<void(std::string_view text, std::chrono::system_clock::time_point submitted)>
      on_command = [](std::string_view, std::chrono::system_clock::time_point) {};
};

// Restarts this program under umockdev's library if needed. Programs without that library are not
// notified when devices come or go. Call this function first in main(). It returns only if no
// restart is needed or the restart fails.
void enter_testbed(char** argv);

// A simulated board. All functions may be called from any thread.
class UsbBoard {
 public:
  // Creates the board unplugged. Also sets UMOCKDEV_DIR in the environment of this process.
  explicit UsbBoard(UsbBoardEvents events);
  ~UsbBoard();
  UsbBoard(const UsbBoard&) = delete;
  UsbBoard& operator=(const UsbBoard&) = delete;

  // Returns "NAME=value" for each environment variable that child processes need.
  std::vector<std::string> environment() const;

  // Unplugs the board if it is plugged in, then powers it on in port 2 of bus 1 ("1-2"). The board
  // keeps only the table's angle.
  Expected<void> plug(const UsbBoardSettings& settings);
  // Powers the board off: transfers in progress fail, and the device disappears.
  void unplug();

  // Stalls the motor until the board restarts.
  void stall();
  // Makes the board send these bytes in addition to the firmware's output.
  void babble(const std::string& bytes);

  double table() const;  // returns the table's angle in degrees
  bool laser() const;
  bool motor() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vitrine::acquisition::rig
