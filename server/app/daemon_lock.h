// SPDX-License-Identifier: Apache-2.0
// Ensures that no two daemons use the same data folder, and detects copied folders.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::server {

struct DataFolderLock {
  FileDescriptor file;
  std::string id;        // ID of the daemon; stays the same when the daemon restarts
  bool is_copy = false;  // whether the folder is a copy of another daemon's; `id` is then new
};

// Locks an existing folder. The lock lasts until the result is destroyed or the process ends for
// any reason. Fails with kState if another daemon holds the lock, and with kIo if the file system
// refuses.
Expected<DataFolderLock> lock_data_folder(const std::filesystem::path& folder);

}  // namespace vitrine::server
