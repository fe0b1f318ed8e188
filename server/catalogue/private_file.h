// SPDX-License-Identifier: Apache-2.0
// Makes files and folders that only their owner can read.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "codec/files/file_descriptor.h"

namespace vitrine::server {

// Creates an empty file that only its owner can read, regardless of the umask and of the folder's
// permissions. Callers use such files for drafts and for hashes of tokens. Replaces a file with the
// same name. On failure, returns an invalid descriptor and sets errno.
inline FileDescriptor create_private_file(const std::filesystem::path& path) {
  ::unlink(path.c_str());
  return FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
}

// Creates an empty file that only its owner can read, unless the file exists. Reports no error,
// because opening the file then fails as well.
inline void ensure_private_file(const std::filesystem::path& path) {
  const FileDescriptor created(
      ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
}

// Takes the rights of other users to a file away. Has no effect if the file does not exist or
// belongs to another user. Does not open the file, because closing it would end the locks that
// SQLite holds on it.
inline void make_private(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || status.st_uid != ::geteuid()) return;
  if (S_ISREG(status.st_mode)) ::chmod(path.c_str(), S_IRUSR | S_IWUSR);
}

// Creates a folder that only its owner can enter, and its missing parents. Does not change a folder
// that exists. Returns whether this call created the folder; on an error, sets `error`.
inline bool create_private_folder(const std::filesystem::path& folder, std::error_code& error) {
  const std::filesystem::path parent = (folder / "").parent_path().parent_path();
  if (!parent.empty()) std::filesystem::create_directories(parent, error);
  if (error) return false;
  if (::mkdir(folder.c_str(), S_IRWXU) == 0) return true;
  const int refusal = errno;
  std::error_code unknown;
  if (!std::filesystem::is_directory(folder, unknown))
    error = std::error_code(refusal, std::generic_category());
  return false;
}

}  // namespace vitrine::server
