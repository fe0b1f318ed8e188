// SPDX-License-Identifier: Apache-2.0
// Lets a command finish cleanly when the user interrupts it.
#pragma once

namespace vitrine::server::cli {

// SIGINT, SIGTERM and SIGHUP ask a command that moves devices to stop in an orderly way; a second
// SIGINT or SIGTERM kills the process.
class StopSignals {
 public:
  StopSignals();  // only one object may exist at a time
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool arrived();
};

}  // namespace vitrine::server::cli
