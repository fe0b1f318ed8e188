// SPDX-License-Identifier: Apache-2.0
// The state and progress of a scan, for display to users.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "acquisition/profile/judge.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

// The states of a scan: idle → checking → scanning → meshing → done. A scan that is checking or
// scanning may become paused or failed; resume() returns it to checking. Every state except done
// may become cancelled.
enum class ScanState { kIdle, kChecking, kScanning, kPaused, kMeshing, kDone, kCancelled, kFailed };

std::string_view name_of(ScanState state);  // returns "idle", "checking", …
constexpr bool is_running(ScanState state) {
  return state == ScanState::kChecking || state == ScanState::kScanning ||
         state == ScanState::kMeshing;
}
std::optional<ScanState> state_of(std::string_view name);

struct ScanStatus {
  ScanState state = ScanState::kIdle;
  int steps = 0, steps_done = 0;       // a step counts as done when its profile is on disk
  StripeCount stripe;                  // sum over all done steps
  double progress = 0;                 // 0 to 1
  std::optional<double> seconds_left;  // nullopt until it can be estimated
  // The reason why the scan waits, such as a lost camera. Usually empty.
  std::string note;
  std::optional<Error> error;  // the cause, if the scan failed
};

}  // namespace vitrine::acquisition
