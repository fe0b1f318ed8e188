// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

namespace vitrine {

// The shortest time in which the other end's kernel has answered, of a TCP connection: no process
// at either end lengthens it. Nothing of other sockets.
std::optional<std::chrono::microseconds> least_round_trip(int socket);

}  // namespace vitrine
