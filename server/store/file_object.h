// SPDX-License-Identifier: Apache-2.0
// An object of the store whose bytes are in a file.
#pragma once

#include <memory>

#include "codec/files/file_descriptor.h"
#include "server/store/object_store.h"

namespace vitrine::server {

// Returns the object in `file`, which is open for reading and contains exactly `size` bytes.
std::unique_ptr<Object> object_in(FileDescriptor file, std::uint64_t size);

inline constexpr std::uint64_t kPieceBytes = 1 << 18;  // bytes that a check reads at a time

// Whether all bytes of the object can be read and have the SHA-256 `name`. Returns false if
// `on_piece` returns false.
bool is_intact(
    const Object& object, const Sha256& name,
    const OnPiece& on_piece = [](std::uint64_t) { return true; });

// Like is_intact(), but reads the bytes from the disk instead of the kernel's cache.
bool is_intact_on_disk(const Object& object, const Sha256& name, const OnPiece& on_piece);

}  // namespace vitrine::server
