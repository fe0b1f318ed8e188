// SPDX-License-Identifier: Apache-2.0
// Bytes that arrive from elsewhere, in a file without a name: it is gone with its last reader.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "codec/files/file_descriptor.h"
#include "server/store/object_store.h"

namespace vitrine {

class LocalCopy {
 public:
  // In that folder. Fails (kIo) where that is refused.
  static Expected<LocalCopy> create(const std::filesystem::path& folder);

  void restart();                                    // with none
  bool append(std::span<const std::uint8_t> bytes);  // false where the disk refuses
  std::optional<Error> fault() const { return fault_; }

  // The object of what has come; null where that has another name.
  Expected<std::unique_ptr<Object>> finish(const Sha256& name) &&;

 private:
  explicit LocalCopy(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
  std::uint64_t size_ = 0;
  std::optional<Error> fault_;
};

}  // namespace vitrine
