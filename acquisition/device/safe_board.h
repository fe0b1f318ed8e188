// SPDX-License-Identifier: Apache-2.0
// What makes a controller a Board: laser and motor go off on every way out.
#pragma once

#include <memory>

#include "acquisition/device/controller.h"
#include "acquisition/device/guardian.h"

namespace vitrine {

// Greets the board and switches it off first.
Expected<std::unique_ptr<Board>> make_safe(OpenedController opened, BoardIdentity identity,
                                           const BoardOptions& options, Guardian guardian);

}  // namespace vitrine
