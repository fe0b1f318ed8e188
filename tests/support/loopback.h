// SPDX-License-Identifier: Apache-2.0
// One connection to 127.0.0.1.
#pragma once

#include <netinet/in.h>

#include <cstdint>

#include "codec/files/file_descriptor.h"

namespace vitrine::test {

sockaddr_in loopback(std::uint16_t port);

// Sends at once what it is given. Throws where nobody accepts.
FileDescriptor connect_to(std::uint16_t port);

}  // namespace vitrine::test
