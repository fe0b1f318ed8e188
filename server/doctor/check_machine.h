// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/doctor/finding.h"

namespace vitrine {

// Clock and limit on open files of the machine that this runs on.
Findings check_machine();

}  // namespace vitrine
