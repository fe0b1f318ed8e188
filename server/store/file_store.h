// SPDX-License-Identifier: Apache-2.0
// The object store in a folder. The object with the name abcd… is the file ROOT/ab/cd/abcd….
#pragma once

#include <filesystem>
#include <memory>

#include "server/store/checked_objects.h"
#include "server/store/object_store.h"

namespace vitrine::server {

class FileStore final : public ObjectStore {
 public:
  // Opens the store in the folder `root`. Creates the folder if it is missing. Fails with kIo.
  static Expected<FileStore> open(const std::filesystem::path& root);

  Expected<bool> put(const Sha256& name, std::span<const std::uint8_t> bytes) override;
  Expected<std::shared_ptr<const ExclusiveLock>> lock() override;
  Expected<void> remove(const Sha256& name) override;
  Expected<void> begin_grace(const Sha256& name) override;
  Expected<std::size_t> sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                              const ExclusiveLock& lock) override;
  Expected<std::unique_ptr<Object>> open(const Sha256& name) const override;
  Expected<ObjectState> check(const Sha256& name, const OnPiece& on_piece) const override;
  Expected<std::optional<std::uint64_t>> size_of(const Sha256& name) const override;

  // Opens an object without checking its bytes, for callers that hash the bytes themselves. Returns
  // null if the object does not exist. Fails with kState if its file cannot be opened, and with kIo
  // if the store fails.
  Expected<std::unique_ptr<Object>> open_unchecked(const Sha256& name) const;

 private:
  explicit FileStore(std::filesystem::path root) : root_(std::move(root)) {}
  std::filesystem::path path_of(const Sha256& name) const;

  std::filesystem::path root_;
  std::unique_ptr<CheckedObjects> checked_ = std::make_unique<CheckedObjects>();
};

}  // namespace vitrine::server
