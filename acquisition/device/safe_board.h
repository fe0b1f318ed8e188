// SPDX-License-Identifier: Apache-2.0
// Makes a Board from a controller. This Board switches laser and motor off however its use ends.
#pragma once

#include <memory>

#include "acquisition/device/controller.h"
#include "acquisition/device/guardian.h"

namespace vitrine::acquisition {

// Greets the board, and switches laser and motor off before returning. Fails for the same reasons
// as open_board().
Expected<std::unique_ptr<Board>> make_safe(OpenedController opened, BoardIdentity identity,
                                           const BoardOptions& options, Guardian guardian);

}  // namespace vitrine::acquisition
