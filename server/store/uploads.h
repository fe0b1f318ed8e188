// SPDX-License-Identifier: Apache-2.0
// Files that arrive piece by piece and survive whatever happens in between: DATA/uploads/ID.json
// says what is expected, ID.part holds what has come. The length of ID.part is the offset, so there
// is nothing else to keep in step with it: file systems grow a file after its bytes are written.
#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"
#include "server/catalogue/model_id.h"

namespace vitrine {

using UploadId = ModelId;

struct Upload {
  UploadId id;
  ModelId token;             // whose it is
  std::uint64_t length = 0;  // bytes in all
  std::uint64_t offset = 0;  // of them, those that are there
  std::string metadata;      // the client's own words, printable ASCII
  std::int64_t expires = 0;  // milliseconds since 1970, UTC; each piece puts it off

  bool is_whole() const { return offset == length; }
};

struct UploadLimits {
  std::uint64_t bytes = 0;                // of one
  std::uint32_t per_token = 0;            // open at a time
  std::chrono::seconds lifetime{86'400};  // since its last piece
};

struct UploadFault {
  enum Kind {
    kTooLarge,  // than one may be, or than was announced
    kTooMany,   // of this token
    kMoved,     // its offset is another
    kGone,      // there is none
    kNoRoom,    // on the disk
    kIo,
  } kind;
  std::string message;
};
template <class T>
using Uploading = tl::expected<T, UploadFault>;

// Appends to one upload. Where another writer does so, too, even in another process, one of them is
// told: no byte ever lands at another offset than its own.
class UploadWriter {
 public:
  Uploading<void> append(std::span<const std::uint8_t> bytes);

  // All that was appended is on the disk on return. The new offset.
  Uploading<std::uint64_t> sync();

 private:
  friend class Uploads;
  UploadWriter(FileDescriptor file, std::uint64_t offset, std::uint64_t length)
      : file_(std::move(file)), offset_(offset), length_(length) {}

  FileDescriptor file_;
  std::uint64_t offset_, length_;
};

// Safe to use from several threads and processes at once.
class Uploads {
 public:
  // The folder is made with the first upload.
  Uploads(std::filesystem::path folder, const UploadLimits& limits)
      : folder_(std::move(folder)), limits_(limits) {}

  const UploadLimits& limits() const { return limits_; }

  // kTooLarge, kTooMany.
  Uploading<Upload> create(const ModelId& token, std::uint64_t length, const std::string& metadata);

  // kGone. The bytes below its offset are on the disk.
  Uploading<Upload> find(const UploadId& id) const;
  Uploading<UploadWriter> writer(const UploadId& id, std::uint64_t offset) const;  // kGone, kMoved

  // Its bytes; kGone where they are not there as a whole, kIo where that cannot be told.
  Uploading<FileDescriptor> open(const UploadId& id) const;

  Uploading<void> remove(const UploadId& id);  // kGone

  Uploading<std::vector<Upload>> list() const;

  // Whoever puts an upload to use, or takes away one that nobody uses, holds this from looking to
  // doing: in this process they are one after the other.
  std::unique_lock<std::mutex> hold() { return std::unique_lock(use_); }

  // Takes away what has expired at `now` and what interrupted calls have left, but for `in_use`
  // and what cannot be read just now. The number of those.
  Uploading<std::size_t> sweep(const std::set<UploadId>& in_use, std::int64_t now);

 private:
  std::filesystem::path path_of(const UploadId& id, const char* suffix) const;
  Uploading<FileDescriptor> lock() const;
  Uploading<Upload> read(const UploadId& id) const;

  const std::filesystem::path folder_;
  const UploadLimits limits_;
  std::mutex use_;
};

}  // namespace vitrine
