// SPDX-License-Identifier: Apache-2.0
// Exchanges lines of text with a controller. Each exchange has a timeout.
#pragma once

#include <optional>
#include <string>

#include "acquisition/device/line_reader.h"
#include "acquisition/device/serial_port.h"

namespace vitrine::acquisition {

class Conversation {
 public:
  Conversation(SerialPort& port, char prompt) : port_(port), reader_(prompt) {}

  SerialPort& port() { return port_; }
  Expected<void> say(std::string_view line);  // `line` excludes the line feed
  // Returns the next line, or nullopt once `deadline` has passed. After the deadline, ignores even
  // a line that has arrived, because this process may have been suspended and another process may
  // have used the board since. For the same reason, take the deadline before say().
  Expected<std::optional<std::string>> hear(SerialPort::Clock::time_point deadline);
  // Discards input until the board has been silent for `quiet`.
  Expected<void> ignore_all(std::chrono::milliseconds quiet);

 private:
  SerialPort& port_;
  LineReader reader_;
};

}  // namespace vitrine::acquisition
