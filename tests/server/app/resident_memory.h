// SPDX-License-Identifier: Apache-2.0
// How much memory another process has.
#pragma once

#include <sys/types.h>

#include <fstream>
#include <string>

namespace vitrine::test {

// `which` of proc(5): what it has now, or at most had ("VmHWM:"). 0 where the process has gone.
inline std::size_t resident_kilobytes(pid_t process, const std::string& which = "VmRSS:") {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(which)) return std::stoul(line.substr(which.size()));
  return 0;
}

}  // namespace vitrine::test
