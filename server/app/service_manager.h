// SPDX-License-Identifier: Apache-2.0
// Notifies systemd of the state of the service (sd_notify(3)). Without systemd, the functions have
// no effect.
#pragma once

#include <chrono>
#include <optional>

namespace vitrine::server {

enum class ServicePhase { kReady, kReloading, kStopping };

void tell_service_manager(ServicePhase phase);

// Returns half of systemd's watchdog interval, so that one delayed notification does not cause a
// restart. Returns nullopt if systemd does not watch the service.
std::optional<std::chrono::microseconds> watchdog_interval();
void tell_alive();

}  // namespace vitrine::server
