// SPDX-License-Identifier: Apache-2.0
// The system on which the daemon runs: its limit on descriptors, its port files and its service
// manager.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "codec/core/expected.h"

namespace vitrine::server {

// Raises the process's limit on descriptors for `wanted` connections, as far as the system allows.
// Returns the number of connections that fit, at least 1. Reserves descriptors for models, the
// catalogue and the logs, so that many connections do not prevent the daemon from opening a model.
std::uint32_t connections_within_limit(std::uint32_t wanted);

// Writes the port and a newline, so that other programs learn which port was bound. Other programs
// never see an incomplete file. Writes no file if the path is empty.
Expected<void> write_port_file(const std::filesystem::path& file, std::uint16_t port);

// The functions below notify systemd of the state of the service (sd_notify(3)). Without systemd,
// they have no effect.
enum class ServicePhase { kReady, kReloading, kStopping };

void tell_service_manager(ServicePhase phase);

// Returns half of systemd's watchdog interval, so that one delayed notification does not cause a
// restart. Returns nullopt if systemd does not watch the service.
std::optional<std::chrono::microseconds> watchdog_interval();
void tell_alive();

}  // namespace vitrine::server
