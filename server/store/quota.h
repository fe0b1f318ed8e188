// SPDX-License-Identifier: Apache-2.0
// What models and uploads together may take of the disk.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "server/catalogue/catalogue.h"
#include "server/store/uploads.h"

namespace vitrine {

// The bytes are also in the data folder, for those who publish there beside the daemon. 0: as much
// as there is. Fails with kIo.
Expected<void> write_quota(const std::filesystem::path& folder, std::uint64_t bytes);
Expected<std::uint64_t> read_quota(const std::filesystem::path& folder);

// Thread-safe. Errors: kLimit where something does not fit, kIo where the catalogue or the disk
// refuses.
class Quota {
 public:
  // Room that nobody else is given as long as this lives.
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

  // `bytes`: 0: as much as there is.
  Quota(Catalogue& catalogue, const Uploads& uploads, std::uint64_t bytes)
      : catalogue_(catalogue), uploads_(uploads), bytes_(bytes) {}

  // Calls `take`, which announces an upload of so many bytes, where they fit beside what models
  // name and uploads have announced. Nobody else is let in meanwhile.
  Expected<void> admit(std::uint64_t bytes, const std::function<void()>& take);

  // Room for the files that a model is going to name, as far as none names them yet. `spent`, of
  // which they are made, goes when they are there: it does not count beside them.
  Expected<Reservation> reserve(std::span<const NamedFile> files,
                                const std::optional<UploadId>& spent);

  // The same where there may be none: null.
  static Expected<Reservation> reserve(Quota* quota, std::span<const NamedFile> files,
                                       const std::optional<UploadId>& spent) {
    return quota == nullptr ? Reservation() : quota->reserve(files, spent);
  }

 private:
  Expected<std::uint64_t> announced(const std::optional<UploadId>& spent) const;  // but for that
  Expected<void> check(std::uint64_t more, std::uint64_t taken) const;
  void release(std::uint64_t bytes);

  Catalogue& catalogue_;
  const Uploads& uploads_;
  const std::uint64_t bytes_;
  std::mutex mutex_;  // guards what follows, and that nobody is let in between asking and taking
  std::uint64_t reserved_ = 0;
};

}  // namespace vitrine
