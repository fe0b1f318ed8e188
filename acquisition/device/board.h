// SPDX-License-Identifier: Apache-2.0
// The controller of turntable and laser.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "codec/core/expected.h"

namespace vitrine {

enum class BoardDialect { kHorus, kFabScan };

// "horus" or "fabscan"; fails with kBadInput on anything else.
Expected<BoardDialect> parse_board_dialect(const std::string& name);
const char* name_of(BoardDialect dialect);

// Which board: of several with the same numbers, the one with that serial number or in that socket.
struct BoardSelector {
  BoardDialect dialect = BoardDialect::kHorus;
  std::uint16_t vendor = 0, product = 0;  // of the USB device
  std::string serial;                     // empty: any
  std::string port;                       // as in "1-2.4": bus, then the sockets; empty: any
  int steps_per_turn = 3200;              // motor steps (FabScan only; Horus boards know theirs)
};

inline constexpr std::chrono::milliseconds kWatchdog{10'000};

struct BoardOptions {
  std::chrono::milliseconds watchdog = kWatchdog;
  std::chrono::milliseconds patience{2'000};  // for an answer, beyond the time a motion takes
  // The program that switches the board off when this process dies; empty: `vitrine-guardian`
  // beside the running program.
  std::filesystem::path guardian;
};

struct BoardIdentity {
  std::string dialect, firmware, serial;  // "horus" or "fabscan"; the banner; of the USB device
};

// Laser and motor are off when it has been opened, and go off whenever it is closed, a call fails,
// no call comes for the watchdog's time, or this process dies. Every call but emergency_stop() is
// made by one thread at a time. An error (kIo) means that the board is to be closed (by destroying
// this) and opened anew.
class Board {
 public:
  virtual ~Board() = default;

  virtual const BoardIdentity& identity() const = 0;

  // Where the table stands, in degrees, to the nearest motor step, as set_position() said and
  // turn_to() went on, also by an earlier process. Nothing where the board cannot know: it has been
  // restarted or stopped in an emergency since, or it is of a kind that does not count (FabScan:
  // known to the process alone that said it).
  virtual Expected<std::optional<double>> position() = 0;
  // States that the table stands at `degrees` now. It stands there afterwards, too, but may have
  // turned to 0 and back: a Horus board's counter can be set at 0 alone.
  virtual Expected<void> set_position(double degrees) = 0;
  // Returns when the motion is complete. `degrees` may exceed a turn. Where position() is nothing,
  // they count from where the board was started.
  virtual Expected<void> turn_to(double degrees) = 0;

  virtual Expected<void> laser(bool on) = 0;

  // Laser and motor off; the table may be moved by hand. The watchdog rests, too, until the next
  // call.
  virtual Expected<void> rest() = 0;

  // Laser and motor off at once, from any thread, in the middle of a motion too. Calls in progress
  // and all later ones fail with kState until the board is opened anew.
  virtual void emergency_stop() noexcept = 0;
};

// Fails with kIo where the board is absent, not accessible or held by another program for more than
// five seconds, and with kBadInput where it is not unique or does not speak that dialect. An
// Arduino restarts when it is opened for the first time after it was plugged in, and only then.
Expected<std::unique_ptr<Board>> open_board(const BoardSelector& selector,
                                            const BoardOptions& options = {});

}  // namespace vitrine
