// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <fstream>
#include <string>

namespace vitrine::test {

// `which` of proc(5): what a process has now, or at most had ("VmHWM:"); 0 where there is none. Its
// children's is not in it.
inline std::size_t resident_bytes(pid_t process, const std::string& which = "VmRSS:") {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(which)) return std::stoul(line.substr(which.size())) * 1024;
  return 0;
}

}  // namespace vitrine::test
