// SPDX-License-Identifier: Apache-2.0
// Checks the machine that the daemon runs on.
#pragma once

#include "server/cli/doctor/finding.h"

namespace vitrine::server {

// Checks the clock and the limit on open files.
Findings check_machine();

}  // namespace vitrine::server
