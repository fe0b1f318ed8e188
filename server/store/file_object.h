// SPDX-License-Identifier: Apache-2.0
// An object of the store whose bytes are in a file.
#pragma once

#include <memory>

#include "codec/files/file_descriptor.h"
#include "server/store/object_store.h"

namespace vitrine::server {

// Returns the object in `file`, which is open for reading and contains exactly `size` bytes.
std::unique_ptr<Object> object_in(FileDescriptor file, std::uint64_t size);

}  // namespace vitrine::server
