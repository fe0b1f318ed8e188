// SPDX-License-Identifier: Apache-2.0
#include "server/app/host_system.h"

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include <string>

namespace vitrine::server {
namespace {

// Returns the message that reports a reload. It contains the current time, because systemd compares
// it with the time of its reload signal (Type=notify-reload).
std::string reloading() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return fmt::format("RELOADING=1\nMONOTONIC_USEC={}",
                     std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

}  // namespace

void tell_service_manager(ServicePhase phase) {
  const std::string state = phase == ServicePhase::kReady      ? "READY=1"
                            : phase == ServicePhase::kStopping ? "STOPPING=1"
                                                               : reloading();
  ::sd_notify(0, state.c_str());
}

std::optional<std::chrono::microseconds> watchdog_interval() {
  std::uint64_t microseconds = 0;
  if (::sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  return std::chrono::microseconds(microseconds / 2);
}

void tell_alive() {
  ::sd_notify(0, "WATCHDOG=1");
}

}  // namespace vitrine::server
