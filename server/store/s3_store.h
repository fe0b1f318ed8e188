// SPDX-License-Identifier: Apache-2.0
// The object store in a bucket of an S3-compatible server. The object with the name abcd… has the
// key PREFIX/objects/abcd…. An empty object PREFIX/grace/abcd… is a mark: the object's grace period
// started again when the mark was written. An open object is a local copy with a verified SHA-256,
// so that the bucket is read only once.
#pragma once

#include <filesystem>
#include <functional>
#include <map>

#include "server/store/object_store.h"
#include "server/store/s3_client.h"

namespace vitrine::server {

// Acquires the store's lock, which is held until the result is destroyed.
using TakeLock = std::function<Expected<std::shared_ptr<const ExclusiveLock>>()>;

struct S3Options {
  S3Address address;
  S3Keys keys;
  std::filesystem::path copies;  // the folder for local copies
  TakeLock lock;                 // acquires the store's lock, because S3 itself has no locks
  std::uint64_t part_bytes = 64 << 20;
  Backoff backoff = {};
};

class S3Store final : public ObjectStore {
 public:
  // Opens the store. Tests access to the bucket: writes, reads, lists and removes a small object.
  // If the test fails, returns kIo and names the step that failed.
  static Expected<std::unique_ptr<S3Store>> open(S3Options options);

  Expected<bool> put(const Sha256& name, std::span<const std::uint8_t> bytes) override;
  Expected<std::shared_ptr<const ExclusiveLock>> lock() override { return options_.lock(); }
  Expected<void> remove(const Sha256& name) override;
  Expected<void> begin_grace(const Sha256& name) override;
  Expected<std::size_t> sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                              const ExclusiveLock& lock) override;
  Expected<std::unique_ptr<Object>> open(const Sha256& name) const override;
  Expected<ObjectState> check(const Sha256& name, const OnPiece& on_piece) const override;
  bool keeps_copies() const override { return true; }
  Expected<std::optional<std::uint64_t>> size_of(const Sha256& name) const override;

 private:
  struct Listing {
    std::map<Sha256, std::int64_t> entries;  // when each object was written, in seconds since 1970
    std::int64_t now = 0;                    // time by the store's clock
  };
  explicit S3Store(S3Options options)
      : options_(std::move(options)), client_(options_.address, options_.keys, options_.backoff) {}
  Expected<void> probe();
  Expected<void> write(const std::string& key, std::span<const std::uint8_t> bytes);
  Expected<void> remove_key(const std::string& key);
  Expected<Listing> list(const std::string& folder);
  Expected<void> give_up_uploads(std::int64_t begun_before);

  const S3Options options_;
  mutable S3Client client_;
};

}  // namespace vitrine::server
