// SPDX-License-Identifier: Apache-2.0
// Where a scan is, for those who watch it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "acquisition/profile/judge.h"
#include "codec/core/expected.h"

namespace vitrine {

//   idle → checking → scanning → meshing → done
// Checking and scanning may become paused or failed, from where resume() goes back to checking;
// everything but done may become cancelled.
enum class ScanState { kIdle, kChecking, kScanning, kPaused, kMeshing, kDone, kCancelled, kFailed };

std::string_view name_of(ScanState state);  // "idle", "checking", …
constexpr bool is_running(ScanState state) {
  return state == ScanState::kChecking || state == ScanState::kScanning ||
         state == ScanState::kMeshing;
}
std::optional<ScanState> state_of(std::string_view name);

struct ScanStatus {
  ScanState state = ScanState::kIdle;
  int steps = 0, steps_done = 0;       // done: the profile is on disk
  StripeCount stripe;                  // in all that are done
  double progress = 0;                 // 0 to 1
  std::optional<double> seconds_left;  // nothing until it can be told
  std::string note;                    // what it waits for: a camera that is gone; mostly empty
  std::optional<Error> error;          // why it failed
};

}  // namespace vitrine
