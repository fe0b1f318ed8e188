// SPDX-License-Identifier: Apache-2.0
// Limits the disk space that models and uploads may use together. Also states the limits on disk
// space to programs that publish without the daemon.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "server/catalogue/catalogue.h"
#include "server/store/uploads.h"

namespace vitrine::server {

// The daemon's limits on disk space, in bytes.
struct DiskLimits {
  std::uint64_t quota = 0;    // largest total size of all models and uploads; 0: no limit
  std::uint64_t reserve = 0;  // free space to keep on the disk
};

// These functions write and read the limits in files of the data folder, so that programs that
// publish without the daemon also know them. Both fail with kIo.
Expected<void> write_limits(const std::filesystem::path& folder, const DiskLimits& limits);
Expected<DiskLimits> read_limits(const std::filesystem::path& folder);

// The limit on the disk space of an installation. Thread-safe. Functions fail with kLimit if there
// is not enough space, and with kIo if the catalogue or the disk fails.
class Quota {
 public:
  // Space that is reserved until this object is destroyed.
  class Reservation {
   public:
    Reservation() = default;
    Reservation(Quota& quota, std::uint64_t bytes) : quota_(&quota), bytes_(bytes) {}
    Reservation(Reservation&& other) noexcept
        : quota_(std::exchange(other.quota_, nullptr)), bytes_(other.bytes_) {}
    Reservation& operator=(Reservation&&) = delete;
    ~Reservation() {
      if (quota_ != nullptr) quota_->release(bytes_);
    }

   private:
    Quota* quota_ = nullptr;
    std::uint64_t bytes_ = 0;
  };

  // `bytes` is the limit in bytes; 0 means no limit.
  Quota(Catalogue& catalogue, const Uploads& uploads, std::uint64_t bytes)
      : catalogue_(catalogue), uploads_(uploads), bytes_(bytes) {}

  // Checks that an upload of `bytes` bytes fits into the quota, together with the models' files and
  // the other uploads. If it fits, calls `take`, which must create the upload. Only one caller at a
  // time checks and creates.
  Expected<void> admit(std::uint64_t bytes, const std::function<void()>& take);

  // Reserves space for the files of a new model. Files that another model already has need no
  // space. The upload `spent`, from which the files were made, does not count, because it is
  // removed afterwards.
  Expected<Reservation> reserve(std::span<const NamedFile> files,
                                const std::optional<UploadId>& spent);

  // Like reserve() above, for `quota`. Returns an empty reservation if `quota` is null.
  static Expected<Reservation> reserve(Quota* quota, std::span<const NamedFile> files,
                                       const std::optional<UploadId>& spent) {
    return quota == nullptr ? Reservation() : quota->reserve(files, spent);
  }

 private:
  // Returns the total length of all uploads except `spent`.
  Expected<std::uint64_t> announced(const std::optional<UploadId>& spent) const;
  Expected<void> check(std::uint64_t more, std::uint64_t taken) const;
  void release(std::uint64_t bytes);

  Catalogue& catalogue_;
  const Uploads& uploads_;
  const std::uint64_t bytes_;
  // Guards the members below. Held from a check until the space is reserved.
  std::mutex mutex_;
  std::uint64_t reserved_ = 0;
};

}  // namespace vitrine::server
