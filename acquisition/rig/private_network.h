// SPDX-License-Identifier: Apache-2.0
// Rigs side by side: GigE Vision's control port is fixed, so that each needs a loopback of its own.
#pragma once

#include "codec/core/expected.h"

namespace vitrine::rig {

// Moves this process, and all it starts from now on, into a network of their own that has nothing
// but a loopback. Call it before there is a second thread. Fails (kIo) where the system does not
// let it.
Expected<void> enter_private_network();

}  // namespace vitrine::rig
