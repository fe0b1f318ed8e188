// SPDX-License-Identifier: Apache-2.0
// A controller board as a USB device that unmodified libusb programs find, started as children with
// environment(). It answers the kernel's usbfs calls through umockdev.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/rig/firmware.h"
#include "acquisition/rig/usb_wire.h"
#include "codec/core/expected.h"

namespace vitrine::rig {

struct UsbBoardSettings {
  bool fabscan = false;  // instead of Horus
  UsbTransport transport = UsbTransport::kCdcAcm;
  std::string serial = "RIG0001";
  FirmwareSettings firmware;
};

// Called from threads of the board's own, one at a time; may not call the board.
struct UsbBoardEvents {
  std::function<void(double degrees)> on_goal = [](double) {};  // where it is to stand; told first
  std::function<void(double degrees)> on_move = [](double) {};  // where the table is now
  std::function<void(double degrees)> on_turn = [](double) {};  // where it has come to stand
  std::function<void(bool on)> on_laser = [](bool) {}, on_motor = [](bool) {};
  std::function<void(std::string_view text)> on_command = [](std::string_view) {};  // as it comes
};

// Starts this program anew under umockdev's library if it is not yet: without it other programs are
// not told when a device comes or goes. To be called first in main(); on failure it returns.
void enter_testbed(char** argv);

// All calls are safe from any thread.
class UsbBoard {
 public:
  // Not plugged in yet. Sets UMOCKDEV_DIR of this process, too, which does no harm here.
  explicit UsbBoard(UsbBoardEvents events);
  ~UsbBoard();
  UsbBoard(const UsbBoard&) = delete;
  UsbBoard& operator=(const UsbBoard&) = delete;

  // "NAME=value" of each variable that children need.
  std::vector<std::string> environment() const;

  // Power on: the board forgets all but where the table is. In socket 2 of bus 1, "1-2".
  // What was plugged in before is unplugged.
  Expected<void> plug(const UsbBoardSettings& settings);
  // Power off: transfers under way fail, the device is gone.
  void unplug();

  // The motor does not turn any more, until the board is restarted.
  void stall();
  // The board sends these bytes, whatever it would have said.
  void babble(const std::string& bytes);

  double table() const;  // degrees
  bool laser() const;
  bool motor() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vitrine::rig
