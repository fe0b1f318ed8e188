// SPDX-License-Identifier: Apache-2.0
// A serial line to a controller, independent of its transport.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::acquisition {

class SerialPort {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~SerialPort() = default;

  // name() is the name in messages, such as "USB board 2341:0043". serial() is the device's serial
  // number, and socket() is its USB port, such as "1-2.4". serial() and socket() are empty if the
  // device has none.
  virtual const std::string& name() const = 0;
  virtual const std::string& serial() const = 0;
  virtual const std::string& socket() const = 0;

  // May be called from any thread.
  virtual Expected<void> write(std::string_view bytes) = 0;
  // Returns the bytes received since the last read(). If there are none, waits until some arrive.
  // Returns an empty string if none arrive before `deadline`. Only one thread at a time may call
  // read().
  virtual Expected<std::string> read(Clock::time_point deadline) = 0;
  // Makes a read() in progress and all later read() calls fail with kState. Callable from any
  // thread.
  virtual void cancel() noexcept = 0;
  // Toggles DTR, which restarts the controller if it reacts to DTR as Arduinos do. Callable from
  // any thread.
  virtual Expected<void> restart_controller() = 0;
};

}  // namespace vitrine::acquisition
