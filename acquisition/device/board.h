// SPDX-License-Identifier: Apache-2.0
// The controller of turntable and laser.
#pragma once

#include <optional>
#include <string>

#include "codec/core/expected.h"

namespace vitrine {

struct BoardIdentity {
  std::string dialect, firmware, serial;  // "horus" or "fabscan"; the banner; of the USB device
};

// Laser and motor are off when it has been opened, and go off whenever it is closed, a call fails,
// or no call comes for the watchdog's time. Every call but emergency_stop() is made by one thread
// at a time. An error (kIo) means that the board is to be closed (by destroying this) and opened
// anew.
class Board {
 public:
  virtual ~Board() = default;

  virtual const BoardIdentity& identity() const = 0;

  // Where the table stands, in degrees, as set_position() said and turn_to() went on, also by an
  // earlier process. Nothing where the board cannot know: it has been restarted since, or it is of
  // a kind that does not count.
  virtual Expected<std::optional<double>> position() = 0;
  // States that the table stands at `degrees` now. Does not move.
  virtual Expected<void> set_position(double degrees) = 0;
  // Returns when the motion is complete. `degrees` may exceed a turn.
  virtual Expected<void> turn_to(double degrees) = 0;

  virtual Expected<void> laser(bool on) = 0;

  // Laser and motor off; the table may be moved by hand. The watchdog rests, too.
  virtual Expected<void> rest() = 0;

  // Laser and motor off at once, from any thread, in the middle of a motion too. Calls in progress
  // and all later ones fail with kState until the board is opened anew.
  virtual void emergency_stop() noexcept = 0;
};

}  // namespace vitrine
