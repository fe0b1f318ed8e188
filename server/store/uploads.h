// SPDX-License-Identifier: Apache-2.0
// Resumable uploads, which survive crashes. DATA/uploads/ID.json describes an upload, and ID.part
// contains the bytes received. The upload's offset is the length of ID.part. This is safe, because
// file systems extend a file only after its bytes are written.
#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"
#include "server/catalogue/id.h"

namespace vitrine::server {

struct Upload {
  UploadId id;
  TokenId token;  // ID of the owner's token
  // Total size in bytes. Until the client has stated it, this is the largest allowed size of an
  // upload.
  std::uint64_t length = 0;
  bool is_length_known = true;
  std::uint64_t offset = 0;  // number of bytes received
  std::string metadata;      // printable ASCII, as the client sent it
  std::int64_t expires = 0;  // milliseconds since 1970, UTC; extended by each part received

  bool is_whole() const { return is_length_known && offset == length; }
};

struct UploadLimits {
  std::uint64_t bytes = 0;                // largest size of an upload, in bytes
  std::uint32_t per_token = 0;            // largest number of open uploads of a token
  std::chrono::seconds lifetime{86'400};  // time until an upload expires after its last part
};

struct UploadFault {
  enum Cause {
    kTooLarge,  // the upload is larger than allowed or announced
    kTooMany,   // too many open uploads for this token
    kMoved,     // the client's offset or length differs from the upload's
    kGone,      // the upload does not exist
    kNoRoom,    // the disk is full
    kIo,
  } cause;
  std::string message;
};
template <class T>
using Uploading = tl::expected<T, UploadFault>;

// Appends bytes to one upload. If another writer, even in another process, appends at the same
// time, one of the two fails. No byte is written at a wrong offset.
class UploadWriter {
 public:
  Uploading<void> append(std::span<const std::uint8_t> bytes);

  // Removes the bytes that this writer has appended, unless another writer has appended more bytes.
  Uploading<void> take_back();

  // Waits until all appended bytes are on the disk, then returns the new offset.
  Uploading<std::uint64_t> sync();

 private:
  friend class Uploads;
  UploadWriter(FileDescriptor file, std::uint64_t offset, std::uint64_t length)
      : file_(std::move(file)), start_(offset), offset_(offset), length_(length) {}

  FileDescriptor file_;
  std::uint64_t start_, offset_, length_;
};

// Safe to use from several threads and processes at once.
class Uploads {
 public:
  // `folder` is created with the first upload.
  Uploads(std::filesystem::path folder, const UploadLimits& limits)
      : folder_(std::move(folder)), limits_(limits) {}

  const UploadLimits& limits() const { return limits_; }

  // Creates an empty upload. `length` is nullopt if the client will state it later. Fails with
  // kTooLarge or kTooMany.
  Uploading<Upload> create(const TokenId& token, std::optional<std::uint64_t> length,
                           const std::string& metadata);

  // States the length of an upload. Fails with kTooLarge if the length exceeds the limit or is
  // smaller than the offset, and with kMoved if another length is known already.
  Uploading<void> state_length(const UploadId& id, std::uint64_t length);

  // Returns an upload, after making sure that the bytes before its offset are on the disk. Fails
  // with kGone if the upload does not exist.
  Uploading<Upload> find(const UploadId& id) const;
  // Returns a writer that appends at `offset`. Fails with kGone if the upload does not exist, and
  // with kMoved if the upload's offset is a different one.
  Uploading<UploadWriter> writer(const UploadId& id, std::uint64_t offset) const;

  // Opens the file of a complete upload. Fails with kGone if the upload does not exist or is
  // incomplete, and with kIo if the file cannot be opened.
  Uploading<FileDescriptor> open(const UploadId& id) const;

  Uploading<void> remove(const UploadId& id);  // fails with kGone if the upload does not exist

  Uploading<std::vector<Upload>> list() const;

  // Acquires the lock that a caller must hold from its check of an upload until it has added a job
  // that uses the upload, or has removed the upload.
  std::unique_lock<std::mutex> hold() { return std::unique_lock(use_); }

  // Removes uploads that expired before `now`, and remains of interrupted calls. Keeps uploads in
  // `in_use` and uploads that cannot be read. Returns the number of uploads removed.
  Uploading<std::size_t> sweep(const std::set<UploadId>& in_use, std::int64_t now);

 private:
  std::filesystem::path path_of(const UploadId& id, const char* suffix) const;
  Uploading<FileDescriptor> lock() const;
  Uploading<Upload> read(const UploadId& id) const;
  tl::unexpected<UploadFault> too_large() const;
  Uploading<void> describe(const UploadId& id, const TokenId& token,
                           std::optional<std::uint64_t> length, const std::string& metadata) const;

  const std::filesystem::path folder_;
  const UploadLimits limits_;
  std::mutex use_;
};

}  // namespace vitrine::server
