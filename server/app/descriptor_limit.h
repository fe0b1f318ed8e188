// SPDX-License-Identifier: Apache-2.0
// Adapts the number of connections to the process's limit on file descriptors.
#pragma once

#include <cstdint>

namespace vitrine::server {

// Raises the process's limit on descriptors for `wanted` connections, as far as the system allows.
// Returns how many connections fit, at least 1. Reserves descriptors for models, the catalogue and
// the logs, so that a flood of connections does not prevent a model from being opened.
std::uint32_t connections_within_limit(std::uint32_t wanted);

}  // namespace vitrine::server
