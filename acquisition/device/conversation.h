// SPDX-License-Identifier: Apache-2.0
// Lines to a controller and its lines back, each within a time.
#pragma once

#include <optional>
#include <string>

#include "acquisition/device/line_reader.h"
#include "acquisition/device/serial_port.h"

namespace vitrine {

class Conversation {
 public:
  Conversation(SerialPort& port, char prompt) : port_(port), reader_(prompt) {}

  SerialPort& port() { return port_; }
  Expected<void> say(std::string_view line);  // without its line feed
  // The next line; nothing where none has come until `deadline`, or the board has not stopped
  // talking by then.
  Expected<std::optional<std::string>> hear(SerialPort::Clock::time_point deadline);
  // Forgets what was said until nothing has come for `quiet`.
  Expected<void> ignore_all(std::chrono::milliseconds quiet);

 private:
  SerialPort& port_;
  LineReader reader_;
};

}  // namespace vitrine
