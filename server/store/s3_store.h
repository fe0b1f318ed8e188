// SPDX-License-Identifier: Apache-2.0
// The object store in a bucket of an S3-compatible server: PREFIX/objects/abcd…, and an empty
// PREFIX/grace/abcd… whose age is that of the grace where that has begun anew. An object that is
// open is a local copy, whose SHA-256 was checked: the bucket is asked for it once.
#pragma once

#include <filesystem>
#include <functional>
#include <map>

#include "server/store/object_store.h"
#include "server/store/s3_client.h"

namespace vitrine {

// Takes a lock that is held until the result is gone.
using TakeLock = std::function<Expected<std::shared_ptr<const ExclusiveLock>>()>;

struct S3Options {
  S3Address address;
  S3Keys keys;
  std::filesystem::path copies;  // the folder for local copies
  TakeLock lock;                 // S3 has none that is free of clocks
  std::uint64_t part_bytes = 64 << 20;
  Backoff backoff = {};
};

class S3Store final : public ObjectStore {
 public:
  // Writes, reads, lists and removes a small object first. Fails (kIo) with what is refused.
  static Expected<std::unique_ptr<S3Store>> open(S3Options options);

  Expected<bool> put(const Sha256& name, std::span<const std::uint8_t> bytes) override;
  Expected<std::shared_ptr<const ExclusiveLock>> lock() override { return options_.lock(); }
  Expected<void> remove(const Sha256& name) override;
  Expected<void> begin_grace(const Sha256& name) override;
  Expected<std::size_t> sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                              const ExclusiveLock& lock) override;
  Expected<std::unique_ptr<Object>> open(const Sha256& name) const override;
  Expected<std::optional<std::uint64_t>> size_of(const Sha256& name) const override;

 private:
  struct Listing {
    std::map<Sha256, std::int64_t> entries;  // when each was written, seconds since 1970
    std::int64_t now = 0;                    // by the store's clock
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

}  // namespace vitrine
