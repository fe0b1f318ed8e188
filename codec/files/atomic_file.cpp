// SPDX-License-Identifier: Apache-2.0
#include "codec/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <random>

#include "codec/files/file_descriptor.h"

namespace vitrine::inline codec {
namespace {

namespace fs = std::filesystem;

}  // namespace

const char* next_step(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder you may write to";
    case ENOENT:
      return "create the folder first";
    case ENOTDIR:
      return "a part of the path is a file: choose another folder";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "check the disk";
  }
}

namespace {

Unexpected refused(const char* what, const fs::path& path, int error) {
  const bool is_full = error == ENOSPC || error == EDQUOT;
  return fail(is_full ? ErrorCode::kLimit : ErrorCode::kIo,
              fmt::format("cannot {} {}: {}; {}", what, path.string(), std::strerror(error),
                          next_step(error)));
}

fs::path temporary_name(const fs::path& path) {
  static thread_local std::mt19937_64 random{std::random_device{}()};
  return folder_of(path) / fmt::format(".{}.{:016x}.part", path.filename().string(), random());
}

// Writes all bytes and syncs the file to disk. Returns 0, or an errno value on failure.
int write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return ::fsync(fd) == 0 ? 0 : errno;
}

int write_new(const fs::path& path, mode_t mode, std::span<const std::uint8_t> bytes) {
  const FileDescriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
  return fd ? write_all(fd.get(), bytes) : errno;
}

}  // namespace

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

Expected<void> sync_folder(const fs::path& folder) {
  const FileDescriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd || ::fsync(fd.get()) != 0) return refused("sync", folder, errno);
  return {};
}

Expected<void> check_writable(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    return fail(ErrorCode::kIo, fmt::format("cannot write {}: it is a folder or a device; choose "
                                            "another name",
                                            path.string()));
  }
  if (::access((folder_of(path) / ".").c_str(), W_OK) != 0) return refused("write", path, errno);
  return {};
}

Expected<void> write_file_atomically(const fs::path& path, std::span<const std::uint8_t> bytes) {
  if (auto writable = check_writable(path); !writable) return writable;
  const fs::path temporary = temporary_name(path);
  int error = write_new(temporary, 0666, bytes);
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return refused("write", path, error);
  }
  return sync_folder(folder_of(path));
}

Expected<bool> create_file_atomically(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const fs::path temporary = temporary_name(path);
  int error = write_new(temporary, 0444, bytes);
  // Creates a hard link instead of renaming, because a link never replaces an existing file.
  if (error == 0 && ::link(temporary.c_str(), path.c_str()) != 0) error = errno;
  ::unlink(temporary.c_str());
  if (error == EEXIST) return false;
  if (error != 0) return refused("write", path, error);
  if (auto synced = sync_folder(folder_of(path)); !synced) {
    return tl::unexpected(synced.error());
  }
  return true;
}

}  // namespace vitrine::inline codec
