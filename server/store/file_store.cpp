// SPDX-License-Identifier: Apache-2.0
#include "server/store/file_store.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "codec/files/atomic_file.h"
#include "codec/files/file_descriptor.h"
#include "server/catalogue/private_file.h"
#include "server/store/file_lock.h"
#include "server/store/file_object.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

Unexpected refused(const char* what, const fs::path& path, const char* why) {
  return fail(ErrorCode::kIo,
              fmt::format("cannot {} {}: {}; check the data folder", what, path.string(), why));
}

// Returns the error for an object whose file is damaged or cannot be opened.
Unexpected damaged(const fs::path& path, const char* why) {
  return fail(ErrorCode::kState, fmt::format("object {} is damaged{}; put it back with 'vitrine "
                                             "repair'",
                                             path.string(), why));
}

// Whether this errno of open(2) or stat(2) says that the store fails: this process lacks resources,
// or a network file system does not respond. All others, such as EIO and EUCLEAN (a damaged inode),
// concern only the file.
bool is_fault_of_store(int error) {
  constexpr int kFaults[] = {EMFILE, ENFILE, ENOMEM, EINTR, ENOTCONN, ESTALE, ETIMEDOUT};
  return std::ranges::find(kFaults, error) != std::end(kFaults);
}

// Returns the error for a file of which open(2) or stat(2) failed with this errno.
Unexpected unreadable(const fs::path& path, int error) {
  if (is_fault_of_store(error)) return refused("open", path, std::strerror(error));
  return damaged(path, fmt::format(": {}", std::strerror(error)).c_str());
}

// Returns the error for a full disk. The message does not contain the path, because clients that
// upload can read the message.
Unexpected full() {
  return fail(ErrorCode::kLimit,
              fmt::format("cannot store a file: {}; free some space or choose another data folder",
                          std::strerror(ENOSPC)));
}

// Whether the object can be read and contains exactly these bytes.
bool holds(const Object& object, std::span<const std::uint8_t> bytes) {
  if (object.size() != bytes.size()) return false;
  std::vector<std::uint8_t> piece;
  for (std::size_t at = 0; at < bytes.size(); at += piece.size()) {
    const auto expected = bytes.subspan(at, std::min(kPieceBytes, bytes.size() - at));
    piece.resize(expected.size());
    if (!object.read(at, std::span(piece)) || !std::ranges::equal(piece, expected)) return false;
  }
  return true;
}

// Returns nullopt if the status of the object's file cannot be read.
std::optional<FileStamp> stamp_of(const Object& object) {
  struct stat status {};
  if (::fstat(*object.descriptor(), &status) != 0) return std::nullopt;
  return FileStamp::of(status);
}

// Creates a folder unless it exists. The new folder survives a power failure.
Expected<void> create_folder(const fs::path& folder) {
  if (::mkdir(folder.c_str(), 0777) == 0) return sync_folder(folder.parent_path());
  if (errno == EEXIST) return {};
  if (errno == ENOSPC || errno == EDQUOT) return full();
  return refused("create", folder, std::strerror(errno));
}

bool is_temporary(const fs::path& path) {
  return path.filename().string().starts_with('.');
}

// Whether a sweep removes the file: it is a temporary file, or it is an object that is not in
// `keep` and whose grace period has ended. The grace period starts at the file's last modification
// time.
bool is_unnamed(const fs::path& path, const std::set<Sha256>& keep, std::chrono::seconds grace) {
  if (is_temporary(path)) return true;
  Sha256 name{};
  struct stat status {};
  if (!from_hex(path.filename().string(), name) || keep.contains(name)) return false;
  if (::stat(path.c_str(), &status) != 0) return false;
  return status.st_mtim.tv_sec + grace.count() <= std::time(nullptr);
}

}  // namespace

Expected<FileStore> FileStore::open(const fs::path& root) {
  std::error_code error;
  create_private_folder(root, error);
  if (error) {
    return fail(ErrorCode::kIo, fmt::format("cannot create {}: {}; {}", root.string(),
                                            error.message(), next_step(error.value())));
  }
  return FileStore(root);
}

fs::path FileStore::path_of(const Sha256& name) const {
  const std::string hex = to_hex(name);
  return root_ / hex.substr(0, 2) / hex.substr(2, 2) / hex;
}

Expected<bool> FileStore::put(const Sha256& name, std::span<const std::uint8_t> bytes) {
  if (sha256(bytes) != name) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the bytes are not those of object {}; send them again", to_hex(name)));
  }
  const fs::path path = path_of(name);
  const fs::path folder = path.parent_path();
  const auto before = open_unchecked(name);
  if (before && *before != nullptr && holds(**before, bytes)) {
    ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
    const auto synced = sync_folder(folder);
    return synced ? Expected<bool>(false) : tl::unexpected(synced.error());
  }
  for (const fs::path& needed : {folder.parent_path(), folder}) {
    if (auto made = create_folder(needed); !made) return tl::unexpected(made.error());
  }
  const auto written = write_file_atomically(path, bytes);
  if (written) return true;
  if (written.error().code == ErrorCode::kLimit) return full();
  return tl::unexpected(written.error());
}

Expected<std::shared_ptr<const ExclusiveLock>> FileStore::lock() {
  auto folder = lock_folder(root_);
  if (!folder) return refused("lock", root_, std::strerror(errno));
  return folder;
}

Expected<std::optional<std::uint64_t>> FileStore::size_of(const Sha256& name) const {
  const fs::path path = path_of(name);
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return static_cast<std::uint64_t>(status.st_size);
  if (errno == ENOENT) return std::nullopt;
  if (!is_fault_of_store(errno)) return 0;
  return refused("look at", path, std::strerror(errno));
}

Expected<void> FileStore::remove(const Sha256& name) {
  const fs::path path = path_of(name);
  if (::unlink(path.c_str()) == 0) return sync_folder(path.parent_path());
  if (errno != ENOENT) return refused("remove", path, std::strerror(errno));
  return {};
}

Expected<void> FileStore::begin_grace(const Sha256& name) {
  const fs::path path = path_of(name);
  if (::utimensat(AT_FDCWD, path.c_str(), nullptr, 0) == 0 || errno == ENOENT) return {};
  const int error = errno;
  const auto object = open_unchecked(name);
  if (!object && object.error().code == ErrorCode::kState) return {};  // no client can read it
  return refused("keep", path, std::strerror(error));
}

Expected<std::size_t> FileStore::sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                                       const ExclusiveLock& lock) {
  std::error_code error;
  std::vector<fs::path> unnamed;
  for (fs::recursive_directory_iterator at(root_, error), end; !error && at != end;
       at.increment(error)) {
    if (at->is_regular_file(error) && is_unnamed(at->path(), keep, grace))
      unnamed.push_back(at->path());
  }
  if (error) return refused("list", root_, error.message().c_str());
  std::size_t swept = 0;
  for (const fs::path& path : unnamed) {
    if (auto held = lock.check(); !held) return tl::unexpected(held.error());
    if (::unlink(path.c_str()) != 0 && errno != ENOENT)
      return refused("remove", path, std::strerror(errno));
    if (!is_temporary(path)) ++swept;
  }
  return swept;
}

Expected<std::unique_ptr<Object>> FileStore::open_unchecked(const Sha256& name) const {
  const fs::path path = path_of(name);
  FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd && errno == ENOENT) return nullptr;
  struct stat status {};
  if (!fd || ::fstat(fd.get(), &status) != 0) return unreadable(path, errno);
  return object_in(std::move(fd), static_cast<std::uint64_t>(status.st_size));
}

// Only the first open() of a file reads and hashes all of it. A file that has been written or
// replaced since counts as a different file.
Expected<std::unique_ptr<Object>> FileStore::open(const Sha256& name) const {
  auto object = open_unchecked(name);
  if (!object || *object == nullptr) return object;
  const auto stamp = stamp_of(**object);
  if (stamp && checked_->contains(name, *stamp)) return object;
  if (!is_intact(**object, name)) return damaged(path_of(name), "");
  if (stamp) checked_->add(name, *stamp);
  return object;
}

Expected<ObjectState> FileStore::check(const Sha256& name, const OnPiece& on_piece) const {
  const auto object = open_unchecked(name);
  if (!object && object.error().code == ErrorCode::kState) return ObjectState::kDamaged;
  if (!object) return tl::unexpected(object.error());
  if (*object == nullptr) return ObjectState::kMissing;
  const auto stamp = stamp_of(**object);
  bool is_stopped = false;
  const bool intact = is_intact_on_disk(**object, name, [&](std::uint64_t length) {
    is_stopped = !on_piece(length);
    return !is_stopped;
  });
  if (is_stopped) return fail(ErrorCode::kIo, "the check was stopped; start it again");
  if (!intact) checked_->forget(name);
  if (intact && stamp) checked_->add(name, *stamp);
  return intact ? ObjectState::kIntact : ObjectState::kDamaged;
}

}  // namespace vitrine::server
