// SPDX-License-Identifier: Apache-2.0
// Gives each rig a network of its own. GigE Vision's control port is fixed, so rigs that run side
// by side need separate networks.
#pragma once

#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

// Moves this process and its future children into a new network namespace that has only a loopback
// interface. Call it before a second thread exists. Fails with kIo if the system does not permit
// it.
Expected<void> enter_private_network();

}  // namespace vitrine::acquisition::rig
