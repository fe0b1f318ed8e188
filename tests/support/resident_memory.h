// SPDX-License-Identifier: Apache-2.0
// Reads how much memory a process uses.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <fstream>
#include <string>

namespace vitrine::test {

// Returns the memory of a process in bytes, without its children; 0 if there is no such process.
// `which` is a key of proc(5), such as "VmRSS:" (now) or "VmHWM:" (the most so far).
inline std::size_t resident_bytes(pid_t process, const std::string& which = "VmRSS:") {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(which)) return std::stoul(line.substr(which.size())) * 1024;
  return 0;
}

}  // namespace vitrine::test
