// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "codec/files/file_descriptor.h"

namespace vitrine {

// An empty file for its owner alone, whatever the umask is and whoever may read the folder: what
// comes into it are hashes of tokens, and drafts. In the place of one of that name. None where the
// system refuses; errno says why.
inline FileDescriptor create_private_file(const std::filesystem::path& path) {
  ::unlink(path.c_str());
  return FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
}

}  // namespace vitrine
