// SPDX-License-Identifier: Apache-2.0
// Opens a connection to 127.0.0.1.
#pragma once

#include <netinet/in.h>

#include <cstdint>

#include "codec/files/file_descriptor.h"

namespace vitrine::test {

sockaddr_in loopback(std::uint16_t port);

// Returns a connection that sends without delay (TCP_NODELAY). Throws if no program listens on the
// port.
FileDescriptor connect_to(std::uint16_t port);

}  // namespace vitrine::test
