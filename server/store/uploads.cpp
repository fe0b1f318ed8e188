// SPDX-License-Identifier: Apache-2.0
#include "server/store/uploads.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "codec/files/atomic_file.h"
#include "server/store/file_lock.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAbout = ".json";
constexpr const char* kBytes = ".part";

tl::unexpected<UploadFault> fault(UploadFault::Cause kind, std::string message) {
  return tl::unexpected(UploadFault{kind, std::move(message)});
}

tl::unexpected<UploadFault> refused(const char* what, int error) {
  const bool full = error == ENOSPC || error == EDQUOT;
  return fault(full ? UploadFault::kNoRoom : UploadFault::kIo,
               fmt::format("cannot {} an upload: {}; {}", what, std::strerror(error),
                           full ? "free some space" : "check the data folder"));
}

tl::unexpected<UploadFault> gone() {
  return fault(UploadFault::kGone, "there is no such upload");
}

class ScopedLock {
 public:
  explicit ScopedLock(int fd) : fd_(fd), is_held_(lock_file(fd)) {}
  ~ScopedLock() { ::flock(fd_, LOCK_UN); }
  ScopedLock(const ScopedLock&) = delete;
  ScopedLock& operator=(const ScopedLock&) = delete;
  bool is_held() const { return is_held_; }

 private:
  const int fd_;
  const bool is_held_;
};

std::optional<std::uint64_t> size_of(int fd) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return std::nullopt;
  return static_cast<std::uint64_t>(status.st_size);
}

// Writes the bytes at `offset` and advances `offset`. If the disk becomes full, keeps the bytes
// that fit.
Uploading<void> write_all(int fd, std::span<const std::uint8_t> bytes, std::uint64_t& offset) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return refused("write", n < 0 ? errno : ENOSPC);
    offset += static_cast<std::uint64_t>(n);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return {};
}

// Returns the fault for `error`, the errno of a failed attempt to open or read an upload. Only
// ENOENT means that the upload does not exist.
tl::unexpected<UploadFault> not_read(int error) {
  return error == ENOENT ? gone() : refused("read", error);
}

// Returns the text of the file that describes an upload.
Uploading<std::string> read_text(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) return not_read(errno);
  std::string text;
  char buffer[4096];
  for (;;) {
    const ssize_t n = ::read(file.get(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return refused("read", errno);
    if (n == 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

std::optional<UploadId> id_of(const fs::path& file) {
  return UploadId::parse(file.stem().string());
}

}  // namespace

Uploading<void> UploadWriter::append(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > length_ - offset_) {
    return fault(UploadFault::kTooLarge, "the upload is longer than its Upload-Length said");
  }
  const ScopedLock lock(file_.get());
  const auto size = size_of(file_.get());
  if (!lock.is_held() || !size) return refused("write", errno);
  if (*size != offset_) {
    return fault(UploadFault::kMoved, "another request writes this upload; ask for its offset");
  }
  return write_all(file_.get(), bytes, offset_);
}

Uploading<void> UploadWriter::take_back() {
  const ScopedLock lock(file_.get());
  const auto size = size_of(file_.get());
  if (!lock.is_held() || !size) return refused("shorten", errno);
  // If the size differs, another writer has appended bytes after those of this writer. The bytes of
  // both then stay.
  if (*size != offset_) return {};
  if (::ftruncate(file_.get(), static_cast<off_t>(start_)) != 0) return refused("shorten", errno);
  offset_ = start_;
  return {};
}

Uploading<std::uint64_t> UploadWriter::sync() {
  if (::fsync(file_.get()) != 0) return refused("keep", errno);
  return offset_;
}

fs::path Uploads::path_of(const UploadId& id, const char* suffix) const {
  return folder_ / (id.to_string() + suffix);
}

Uploading<FileDescriptor> Uploads::lock() const {
  FileDescriptor folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder || !lock_file(folder.get())) return refused("make", errno);
  return folder;
}

// Writes the file that describes an upload.
Uploading<void> Uploads::describe(const UploadId& id, const TokenId& token,
                                  std::optional<std::uint64_t> length,
                                  const std::string& metadata) const {
  nlohmann::json about = {
      {"token", token.to_string()}, {"length", nullptr}, {"metadata", metadata}};
  if (length) about["length"] = *length;
  const std::string text = about.dump();
  const auto kept = write_file_atomically(
      path_of(id, kAbout), {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (kept) return {};
  const bool is_full = kept.error().code == ErrorCode::kLimit;
  return refused("make", is_full ? ENOSPC : EIO);
}

tl::unexpected<UploadFault> Uploads::too_large() const {
  return fault(UploadFault::kTooLarge,
               fmt::format("an upload may have {} bytes at most", limits_.bytes));
}

Uploading<Upload> Uploads::create(const TokenId& token, std::optional<std::uint64_t> length,
                                  const std::string& metadata) {
  if (length && *length > limits_.bytes) return too_large();
  if (::mkdir(folder_.c_str(), S_IRWXU) != 0 && errno != EEXIST) return refused("make", errno);
  const auto locked = lock();
  if (!locked) return tl::unexpected(locked.error());
  const auto all = list();
  if (!all) return tl::unexpected(all.error());
  const auto own = std::ranges::count(*all, token, &Upload::token);
  if (static_cast<std::uint64_t>(own) >= limits_.per_token) {
    return fault(UploadFault::kTooMany,
                 fmt::format("this token has {} uploads open; finish or delete one", own));
  }
  const UploadId id = UploadId::generate();
  const FileDescriptor bytes(
      ::open(path_of(id, kBytes).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!bytes) return refused("make", errno);
  const auto described = describe(id, token, length, metadata);
  if (described) return find(id);
  ::unlink(path_of(id, kBytes).c_str());
  return tl::unexpected(described.error());
}

Uploading<void> Uploads::state_length(const UploadId& id, std::uint64_t length) {
  const auto locked = lock();
  if (!locked) return tl::unexpected(locked.error());
  const auto upload = read(id);
  if (!upload) return tl::unexpected(upload.error());
  if (upload->is_length_known && upload->length == length) return {};
  if (upload->is_length_known) {
    return fault(UploadFault::kMoved,
                 fmt::format("the upload's length is {} and does not change", upload->length));
  }
  if (length > limits_.bytes) return too_large();
  if (length < upload->offset) {
    return fault(UploadFault::kTooLarge,
                 fmt::format("the upload has {} bytes already", upload->offset));
  }
  return describe(id, upload->token, length, upload->metadata);
}

Uploading<Upload> Uploads::read(const UploadId& id) const {
  const auto about = read_text(path_of(id, kAbout));
  if (!about) return tl::unexpected(about.error());
  struct stat status {};
  if (::stat(path_of(id, kBytes).c_str(), &status) != 0) return not_read(errno);
  const auto json = nlohmann::json::parse(*about, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) {
    return fault(
        UploadFault::kIo,
        fmt::format("upload {0} is damaged; remove {0}.json and {0}.part", id.to_string()));
  }
  Upload upload;
  upload.id = id;
  upload.token = TokenId::parse(json.value("token", "")).value_or(TokenId());
  const auto length = json.find("length");
  upload.is_length_known = length == json.end() || !length->is_null();
  upload.length = upload.is_length_known ? json.value("length", std::uint64_t{0}) : limits_.bytes;
  upload.offset = static_cast<std::uint64_t>(status.st_size);
  upload.metadata = json.value("metadata", "");
  upload.expires = std::int64_t{status.st_mtim.tv_sec} * 1000 +
                   std::chrono::duration_cast<std::chrono::milliseconds>(limits_.lifetime).count();
  return upload;
}

// Syncs the bytes before returning their number, because a daemon that crashed may have left bytes
// that are not on the disk yet. A client that receives this offset does not send these bytes again.
Uploading<Upload> Uploads::find(const UploadId& id) const {
  auto upload = read(id);
  if (!upload) return upload;
  const FileDescriptor bytes(::open(path_of(id, kBytes).c_str(), O_RDONLY | O_CLOEXEC));
  if (!bytes || ::fsync(bytes.get()) != 0) return not_read(errno);
  return upload;
}

Uploading<UploadWriter> Uploads::writer(const UploadId& id, std::uint64_t offset) const {
  const auto upload = read(id);
  if (!upload) return tl::unexpected(upload.error());
  if (upload->offset != offset) {
    return fault(UploadFault::kMoved,
                 fmt::format("the upload's offset is {}; continue there", upload->offset));
  }
  FileDescriptor bytes(::open(path_of(id, kBytes).c_str(), O_WRONLY | O_CLOEXEC));
  if (!bytes) return not_read(errno);
  return UploadWriter(std::move(bytes), offset, upload->length);
}

Uploading<FileDescriptor> Uploads::open(const UploadId& id) const {
  const auto upload = read(id);
  if (!upload) return tl::unexpected(upload.error());
  if (!upload->is_whole()) return gone();
  FileDescriptor bytes(::open(path_of(id, kBytes).c_str(), O_RDONLY | O_CLOEXEC));
  if (!bytes) return not_read(errno);
  return bytes;
}

// Removes the description first, because an upload without a description counts as non-existent.
Uploading<void> Uploads::remove(const UploadId& id) {
  if (::unlink(path_of(id, kAbout).c_str()) != 0) {
    if (errno == ENOENT) return gone();
    return refused("remove", errno);
  }
  ::unlink(path_of(id, kBytes).c_str());
  if (const auto synced = sync_folder(folder_); !synced)
    return fault(UploadFault::kIo, synced.error().message);
  return {};
}

Uploading<std::vector<Upload>> Uploads::list() const {
  std::vector<Upload> all;
  std::error_code error;
  fs::directory_iterator at(folder_, error);
  if (error == std::errc::no_such_file_or_directory) return all;
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    if (at->path().extension() != kAbout) continue;
    const auto id = id_of(at->path());
    const auto upload = id ? read(*id) : gone();
    if (upload) all.push_back(*upload);
  }
  if (error) return refused("list", error.value());
  return all;
}

Uploading<std::size_t> Uploads::sweep(const std::set<UploadId>& in_use, std::int64_t now) {
  std::error_code error;
  if (!fs::exists(folder_, error)) return 0;
  const auto locked = lock();
  if (!locked) return tl::unexpected(locked.error());
  std::size_t swept = 0;
  std::vector<fs::path> files;
  fs::directory_iterator at(folder_, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error))
    files.push_back(at->path());
  for (const fs::path& file : files) {
    const auto id = id_of(file);
    const auto upload = id ? read(*id) : gone();
    if (upload && (upload->expires > now || in_use.contains(*id))) continue;
    // Keeps an upload that cannot be read, because it may still be in use.
    if (!upload && upload.error().cause != UploadFault::kGone) continue;
    if (file.extension() == kAbout) ++swept;
    ::unlink(file.c_str());
  }
  if (error) return refused("list", error.value());
  return swept;
}

}  // namespace vitrine::server
