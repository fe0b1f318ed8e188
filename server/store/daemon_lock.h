// SPDX-License-Identifier: Apache-2.0
// Ensures that no two daemons use the same data folder, and detects copied folders.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::server {

struct DataFolderLock {
  FileDescriptor file;
  std::string id;        // ID of the daemon; stays the same when the daemon restarts
  bool is_copy = false;  // whether the folder is a copy of another one; if so, `id` is a new ID
};

void pause_for_lock();  // pauses for 10 ms

// Locks an existing folder. The lock lasts until the result is destroyed or the process ends for
// any reason. After a daemon was killed, its child processes may still hold the lock for a moment.
// Therefore tries 200 times, and calls `pause` between two attempts. Fails with kState if another
// daemon holds the lock, and with kIo if the file system refuses.
Expected<DataFolderLock> lock_data_folder(const std::filesystem::path& folder,
                                          const std::function<void()>& pause = pause_for_lock);

}  // namespace vitrine::server
