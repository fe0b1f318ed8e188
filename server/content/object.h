// SPDX-License-Identifier: Apache-2.0
// A stored object as it is read and sent. server/store/object_store.h opens objects.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server {

// An object that is open for reading. It stays readable until it is destroyed, even if the store
// removes it. Safe to use from several threads at once.
class Object {
 public:
  virtual ~Object() = default;

  virtual std::uint64_t size() const = 0;

  // Fills `out` with the bytes from `offset` on. Fails with kIo if they extend beyond the object's
  // end.
  virtual Expected<void> read(std::uint64_t offset, std::span<std::uint8_t> out) const = 0;

  // Returns a descriptor for sendfile(2), which the object owns, or nullopt if the object is not in
  // a file. All users share the descriptor's file position, so pass an explicit offset to sendfile.
  virtual std::optional<int> descriptor() const { return std::nullopt; }

  Expected<std::vector<std::uint8_t>> read(std::uint64_t offset, std::uint64_t length) const;
};

}  // namespace vitrine::server
