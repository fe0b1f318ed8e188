// SPDX-License-Identifier: Apache-2.0
// The body of a response: a text, shared memory, or a range of a stored object, which can be sent
// from the page cache without a copy.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "server/content/object.h"

namespace vitrine::server {

struct SharedBytes {
  std::shared_ptr<const void> owner;  // null if the bytes are static
  std::span<const std::uint8_t> bytes;
  // Size in bytes of the memory that the owner keeps. `bytes` may be a range of this memory.
  std::uint64_t memory = bytes.size();
};

struct StoredBytes {
  std::shared_ptr<const Object> object;
  std::uint64_t offset = 0, length = 0;
};

using Body = std::variant<std::string, SharedBytes, StoredBytes>;

std::uint64_t body_size(const Body& body);

// Returns the size in bytes of the memory that the body occupies until it is sent. This is 0 for
// stored bytes and static memory.
std::uint64_t body_memory(const Body& body);

// Returns the bytes [offset, offset + length) of `body`. The range must lie within `body`.
Body body_range(Body body, std::uint64_t offset, std::uint64_t length);

}  // namespace vitrine::server
