// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vitrine::cli {

// SIGINT, SIGTERM and SIGHUP ask a command that moves things to come to rest; a second SIGINT or
// SIGTERM ends the process as ever.
class StopSignals {
 public:
  StopSignals();  // one at a time
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool arrived();
};

}  // namespace vitrine::cli
