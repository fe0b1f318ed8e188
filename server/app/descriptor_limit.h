// SPDX-License-Identifier: Apache-2.0
// How many connections the process has file descriptors for.
#pragma once

#include <cstdint>

namespace vitrine {

// Raises the process's limit on descriptors as far as `wanted` connections need it and the system
// allows, and returns how many of them fit, at least 1. Open models, the catalogue and the logs
// have their share first: a flood of connections must not keep a model from being opened.
std::uint32_t connections_within_limit(std::uint32_t wanted);

}  // namespace vitrine
