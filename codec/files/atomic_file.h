// SPDX-License-Identifier: Apache-2.0
// Writes files atomically: a reader sees the complete new file or no change. Each write creates a
// temporary file in the same folder, syncs it, gives it its final name, and syncs the folder.
// Functions that fail with kIo fail with kLimit instead if the disk is full.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Checks that `path` can be written; call it before long work. Fails (kIo) if the folder of `path`
// is missing or read-only, or if `path` is a folder or a device.
Expected<void> check_writable(const std::filesystem::path& path);

// Replaces the contents of the file `path` by `bytes`. On failure (kIo), the temporary file is
// removed, and the file `path` is unchanged unless only the last sync of the folder failed. The
// name of the temporary file starts with a dot.
Expected<void> write_file_atomically(const std::filesystem::path& path,
                                     std::span<const std::uint8_t> bytes);

// Creates the file `path` with read-only permissions and returns true. If the file exists already,
// leaves it unchanged and returns false. If several callers create the same file at once, exactly
// one gets true.
Expected<bool> create_file_atomically(const std::filesystem::path& path,
                                      std::span<const std::uint8_t> bytes);

// Returns advice for a user whose file or folder cannot be written. `error` is the error number
// (errno).
const char* next_step(int error);

// Returns the folder of `path`, or "." if `path` is only a file name.
std::filesystem::path folder_of(const std::filesystem::path& path);

// Syncs `folder` to disk, so that new and renamed files in it survive a power failure.
Expected<void> sync_folder(const std::filesystem::path& folder);

}  // namespace vitrine::inline codec
