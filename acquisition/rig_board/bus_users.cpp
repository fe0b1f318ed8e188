// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_board/bus_users.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace vitrine::acquisition::rig {
namespace {

bool has(const std::filesystem::path& process, const std::string& variable) {
  std::ifstream file(process / "environ", std::ios::binary);
  const std::string environment{std::istreambuf_iterator<char>(file), {}};
  return ('\0' + environment).find('\0' + variable + '\0') != std::string::npos;
}

bool is_used(const std::string& variable) {
  const std::string self = std::to_string(::getpid());
  std::error_code ended;  // a process may end while the list is read
  for (std::filesystem::directory_iterator it("/proc", ended), end; !ended && it != end;
       it.increment(ended)) {
    const std::string name = it->path().filename();
    const bool is_process = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
    if (is_process && name != self && has(it->path(), variable)) return true;
  }
  return false;
}

}  // namespace

void wait_for_users_of(const std::string& variable, std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (is_used(variable) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

}  // namespace vitrine::acquisition::rig
