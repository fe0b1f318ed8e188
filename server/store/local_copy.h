// SPDX-License-Identifier: Apache-2.0
// A local copy of a remote object, in an unnamed file. The system deletes the file when its last
// reader closes it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "codec/files/file_descriptor.h"
#include "server/store/object_store.h"

namespace vitrine::server {

class LocalCopy {
 public:
  // Creates an empty copy in `folder`. Fails with kIo.
  static Expected<LocalCopy> create(const std::filesystem::path& folder);

  void restart();                                    // discards the bytes received so far
  bool append(std::span<const std::uint8_t> bytes);  // returns false on a disk error
  std::optional<Error> fault() const { return fault_; }

  // Returns an object with the received bytes, or null if their SHA-256 differs from `name`.
  Expected<std::unique_ptr<Object>> finish(const Sha256& name) &&;

 private:
  explicit LocalCopy(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
  std::uint64_t size_ = 0;
  std::optional<Error> fault_;
};

}  // namespace vitrine::server
