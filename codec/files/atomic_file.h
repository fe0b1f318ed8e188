// SPDX-License-Identifier: Apache-2.0
// Writes files atomically: a reader sees either the complete new file or no change. Each write
// creates a temporary file in the same folder, syncs it, gives it its final name, and syncs the
// folder. If the disk is full, functions fail with kLimit instead of kIo.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Checks that `path` can be written. Call this before long work whose result goes to `path`. Fails
// (kIo) if the folder of `path` is missing or read-only, or if `path` is a folder or a device.
Expected<void> check_writable(const std::filesystem::path& path);

// Replaces the contents of the file `path` by `bytes`. On failure (kIo), removes the temporary file
// and leaves `path` unchanged, unless only the final sync of the folder failed. The name of the
// temporary file starts with a dot.
Expected<void> write_file_atomically(const std::filesystem::path& path,
                                     std::span<const std::uint8_t> bytes);

// Creates the file `path` with read-only permissions and returns true. If the file already exists,
// leaves it unchanged and returns false. If several callers create the same file at the same time,
// exactly one of them gets true.
Expected<bool> create_file_atomically(const std::filesystem::path& path,
                                      std::span<const std::uint8_t> bytes);

// Returns advice for a user whose file or folder cannot be written: the next step for the errno
// value `error`.
const char* next_step(int error);

// Returns the folder of `path`, or "." if `path` is only a file name.
std::filesystem::path folder_of(const std::filesystem::path& path);

// Syncs `folder` to disk, so that new and renamed files in it survive a power failure.
Expected<void> sync_folder(const std::filesystem::path& folder);

}  // namespace vitrine::inline codec
