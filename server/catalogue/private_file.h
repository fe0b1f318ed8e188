// SPDX-License-Identifier: Apache-2.0
// Creates files that only their owner can read.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "codec/files/file_descriptor.h"

namespace vitrine::server {

// Creates an empty file that only its owner can read, regardless of the umask and of the folder's
// permissions. The callers write hashes of tokens, and drafts, to it. Replaces a file with the same
// name. On failure, returns an invalid descriptor and sets errno.
inline FileDescriptor create_private_file(const std::filesystem::path& path) {
  ::unlink(path.c_str());
  return FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
}

}  // namespace vitrine::server
