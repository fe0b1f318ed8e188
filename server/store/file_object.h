// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "codec/files/file_descriptor.h"
#include "server/store/object_store.h"

namespace vitrine {

// The object whose bytes are all of an open file.
std::unique_ptr<Object> object_in(FileDescriptor file, std::uint64_t size);

}  // namespace vitrine
