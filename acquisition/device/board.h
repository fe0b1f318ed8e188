// SPDX-License-Identifier: Apache-2.0
// Drives the controller board of turntable and laser.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/device/power_record.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

enum class BoardDialect { kHorus, kFabScan };

// Accepts "horus" or "fabscan". Fails with kBadInput on any other name.
Expected<BoardDialect> parse_board_dialect(const std::string& name);
const char* name_of(BoardDialect dialect);

// Selects a board by the vendor and product numbers of its USB device. Set the serial number or the
// port if several boards have the same numbers.
struct BoardSelector {
  BoardDialect dialect = BoardDialect::kHorus;
  std::uint16_t vendor = 0, product = 0;
  std::string serial;  // serial number of the USB device; empty: any
  std::string port;    // USB bus, then hub ports, such as "1-2.4"; empty: any port
  // Motor steps in one revolution. Used for FabScan only; Horus boards report the number
  // themselves.
  int steps_per_turn = 3200;
};

inline constexpr std::chrono::milliseconds kWatchdog{10'000};

struct BoardOptions {
  std::chrono::milliseconds watchdog = kWatchdog;
  // How long to wait for an answer, in addition to the duration of a motion.
  std::chrono::milliseconds response_timeout{2'000};
  // The program that switches the board off if this process dies. Empty: `vitrine-guardian` in the
  // folder of the running program.
  std::filesystem::path guardian;
  // Receives the state of laser and motor until the board is destroyed.
  std::shared_ptr<PowerRecord> power = std::make_shared<PowerRecord>();
};

struct BoardIdentity {
  // dialect: "horus" or "fabscan". firmware: the banner that the board sent. serial: the serial
  // number of its USB device.
  std::string dialect, firmware, serial;
};

// An open controller board. Laser and motor are off after opening. They are switched off again when
// the board is closed, a call fails, no call arrives within the watchdog's time, or this process
// dies. Only one thread at a time may call, except for emergency_stop(). After an error (kIo),
// close the board by destroying this object and open it again.
class Board {
 public:
  virtual ~Board() = default;

  virtual const BoardIdentity& identity() const = 0;

  // Returns the table's angle in degrees, to the nearest motor step. The angle is the last
  // set_position() plus all later motions, even those of an earlier process. Returns nullopt if the
  // board does not know the angle, as after a restart or an emergency stop. A FabScan board does
  // not count steps, so its angle is known only in the process that set it.
  virtual Expected<std::optional<double>> position() = 0;
  // Declares that the table stands at `degrees` now. The table may turn to 0 and back to where it
  // stood, because a Horus board can reset its counter only at 0.
  virtual Expected<void> set_position(double degrees) = 0;
  // Turns the table to an angle and returns when the motion is complete. `degrees` may exceed a
  // revolution. If position() is nullopt, degrees count from the angle at which the board was
  // started.
  virtual Expected<void> turn_to(double degrees) = 0;

  virtual Expected<void> laser(bool on) = 0;

  // Switches laser and motor off, so that the table can be turned by hand. The watchdog pauses
  // until the next call.
  virtual Expected<void> rest() = 0;

  // Switches laser and motor off at once, even during a motion. Callable from any thread. Calls in
  // progress and all later calls fail with kState until the board is opened again.
  virtual void emergency_stop() noexcept = 0;
};

// Finds and opens a board. Fails with kIo if the board is absent, not accessible, or held by
// another program for more than five seconds. Fails with kBadInput if several boards match or the
// board does not speak the dialect. An Arduino restarts only when it is opened for the first time
// after being plugged in.
Expected<std::unique_ptr<Board>> open_board(const BoardSelector& selector,
                                            const BoardOptions& options = {});

}  // namespace vitrine::acquisition
