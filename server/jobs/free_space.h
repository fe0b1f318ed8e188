// SPDX-License-Identifier: Apache-2.0
// Free space on the disks to which a daemon writes.
#pragma once

#include <cstdint>

#include "server/config/settings.h"

namespace vitrine::server {

// Returns the number of free bytes on the disk of the data folder or on the disk of the uploads,
// whichever is less.
std::uint64_t free_space(const Settings& settings);

}  // namespace vitrine::server
