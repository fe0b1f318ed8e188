// SPDX-License-Identifier: Apache-2.0
// A serial line to a controller, whatever carries it.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine {

class SerialPort {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~SerialPort() = default;

  // "USB board 2341:0043", for messages; its serial number; and its socket, "1-2.4". The latter two
  // are empty where it has none.
  virtual const std::string& name() const = 0;
  virtual const std::string& serial() const = 0;
  virtual const std::string& socket() const = 0;

  // From any thread.
  virtual Expected<void> write(std::string_view bytes) = 0;
  // What has come since the last read(); waits for something, at most until `deadline`, and is
  // empty then. By one thread at a time.
  virtual Expected<std::string> read(Clock::time_point deadline) = 0;
  // A read() in progress and all later ones fail with kState. From any thread.
  virtual void cancel() noexcept = 0;
  // Restarts the controller behind the line, if it listens to DTR as Arduinos do. From any thread.
  virtual Expected<void> restart_controller() = 0;
};

}  // namespace vitrine
