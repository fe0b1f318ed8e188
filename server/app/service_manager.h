// SPDX-License-Identifier: Apache-2.0
// What systemd is told (sd_notify(3)); where it has not started this process, nobody is told.
#pragma once

#include <chrono>
#include <optional>

namespace vitrine {

enum class ServicePhase { kReady, kReloading, kStopping };

void tell_service_manager(ServicePhase phase);

// How often it wants to hear that the service is alive, halved, so that one delay costs nothing;
// nothing where it does not watch.
std::optional<std::chrono::microseconds> watchdog_interval();
void tell_alive();

}  // namespace vitrine
