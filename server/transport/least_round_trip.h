// SPDX-License-Identifier: Apache-2.0
// Reads the smallest round-trip time of a TCP connection.
#pragma once

#include <chrono>
#include <optional>

namespace vitrine::server {

// Returns the smallest round-trip time that the kernel has measured on the connection. It does not
// include delays by the processes at either end. Returns nullopt if `socket` is not a TCP socket or
// nothing was measured yet.
std::optional<std::chrono::microseconds> least_round_trip(int socket);

}  // namespace vitrine::server
