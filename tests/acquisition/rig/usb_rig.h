// SPDX-License-Identifier: Apache-2.0
// Controls the simulated USB board that usb_host.cpp provides to this test.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace vitrine::test {

class UsbRig {
 public:
  UsbRig() : socket_(std::atoi(std::getenv("VITRINE_USB_RIG"))) {}

  // Sends a command and returns the answer. Commands: `plug DIALECT TRANSPORT [DEGREES A SECOND]`,
  // unplug, stall, babble TEXT, table, laser, motor.
  std::string ask(const std::string& command) const {
    const std::string line = command + '\n';
    if (::write(socket_, line.data(), line.size()) < 0) throw std::runtime_error("no rig");
    std::string answer;
    for (char byte = 0; ::read(socket_, &byte, 1) == 1 && byte != '\n';)
      answer += byte;
    return answer;
  }
  double table() const { return std::stod(ask("table")); }

 private:
  int socket_;
};

}  // namespace vitrine::test
