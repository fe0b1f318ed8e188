// SPDX-License-Identifier: Apache-2.0
// Two daemons never share a data folder by accident.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

namespace vitrine {

struct DataFolderLock {
  FileDescriptor file;
  std::string id;        // of the daemon of this folder: the same at its next start
  bool is_copy = false;  // of another daemon's folder, whose id this one does not take
};

// Holds `folder`, which exists, for this process until the result is gone, however the process
// ends. Fails with kState where another daemon has it, kIo where the file system refuses.
Expected<DataFolderLock> lock_data_folder(const std::filesystem::path& folder);

}  // namespace vitrine
