// SPDX-License-Identifier: Apache-2.0
// Adapts the number of connections to the process's limit on file descriptors.
#pragma once

#include <cstdint>

namespace vitrine::server {

// Raises the process's limit on descriptors for `wanted` connections, as far as the system allows.
// Returns the number of connections that fit, at least 1. Reserves descriptors for models, the
// catalogue and the logs, so that many connections do not prevent the daemon from opening a model.
std::uint32_t connections_within_limit(std::uint32_t wanted);

}  // namespace vitrine::server
