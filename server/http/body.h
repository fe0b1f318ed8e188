// SPDX-License-Identifier: Apache-2.0
// What a response carries: text of its own, memory that something else keeps alive, or a range of a
// stored object that goes from the page cache to the socket.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "server/store/object_store.h"

namespace vitrine {

struct SharedBytes {
  std::shared_ptr<const void> owner;  // null where the bytes are static
  std::span<const std::uint8_t> bytes;
};

struct StoredBytes {
  std::shared_ptr<const Object> object;
  std::uint64_t offset = 0, length = 0;
};

using Body = std::variant<std::string, SharedBytes, StoredBytes>;

std::uint64_t body_size(const Body& body);

// The bytes [offset, offset + length) of `body`, which must lie within it.
Body body_range(Body body, std::uint64_t offset, std::uint64_t length);

}  // namespace vitrine
