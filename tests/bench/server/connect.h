// SPDX-License-Identifier: Apache-2.0
// One connection to 127.0.0.1.
#pragma once

#include <cstdint>

#include "codec/files/file_descriptor.h"

namespace vitrine::bench {

// Throws where nobody accepts.
FileDescriptor connect_to(std::uint16_t port);

}  // namespace vitrine::bench
