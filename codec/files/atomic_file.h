// SPDX-License-Identifier: Apache-2.0
// Files that are whole or absent: temporary in the same folder, write, fsync, rename, fsync folder.
// Whatever fails with kIo fails with kLimit where the disk is full.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "codec/core/expected.h"

namespace vitrine {

// Whether a file can be created at `path`, asked before long work. Fails (kIo) where its folder is
// missing or read-only, or where what has that name is no file: a folder or a device.
Expected<void> check_writable(const std::filesystem::path& path);

// Replaces `path` by `bytes`. Fails with kIo, and then `path` is as it was and the temporary file,
// whose name starts with a dot, is gone.
Expected<void> write_file_atomically(const std::filesystem::path& path,
                                     std::span<const std::uint8_t> bytes);

// Creates `path`, read-only, unless it exists: false then, and the file is as it was. Of several
// that create it at a time one succeeds.
Expected<bool> create_file_atomically(const std::filesystem::path& path,
                                      std::span<const std::uint8_t> bytes);

// What to do where a file or folder cannot be written for that error number.
const char* next_step(int error);

// Where a file of that name is; `.` for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& path);

// Makes the names in `folder` durable.
Expected<void> sync_folder(const std::filesystem::path& folder);

}  // namespace vitrine
