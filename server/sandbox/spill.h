// SPDX-License-Identifier: Apache-2.0
// Allocates large blocks out of core. Once a process uses a certain share of its memory limit,
// further large blocks are mapped from an unnamed file, the spill file. Their pages are unmapped
// when the process uses too much memory. Programs that link this file use it through operator new.
// Algorithms need no changes, and results stay the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "codec/core/expected.h"

namespace vitrine::server {

struct SpillOptions {
  // The folder of the spill file, on a disk with free space. If empty, blocks do not spill.
  std::filesystem::path folder = {};
  // Limit of the process's resident memory, in bytes. The process exceeds it only if blocks that do
  // not spill need more.
  std::uint64_t resident_bytes = 2ull << 30;
  // Largest size of the spill file. The default suffices for 300 million triangles, and any system
  // can map it.
  std::uint64_t max_bytes = 64ull << 30;
  // Free space that the spill file leaves on its disk, in bytes.
  std::uint64_t disk_reserve = 0;
  // A read-only mapping of a file from its start. Its pages may be unmapped as well to save memory.
  std::span<const std::uint8_t> input = {};
};

// Starts spilling for the rest of the process's life. Call this once, while the process has one
// thread. Then call start_trimming() when threads may be started; the process may give up the right
// to open files between the two calls. The spill file immediately reserves address space: as much
// as half of the disk's free space beyond disk_reserve, but at most max_bytes and at most
// RLIMIT_FSIZE. Blocks that do not fit into the file use memory instead, and so do all blocks if
// the disk cannot hold or map such a file. Fails with kIo if no file can be created. If other
// programs fill the disk later, the process ends with SIGBUS.
Expected<void> open_spill(const SpillOptions& options);
void start_trimming();

// The functions below return 0 if the process does not spill.
std::uint64_t spill_capacity();  // address space of the spill file, in bytes
std::uint64_t spilled_bytes();   // total size in bytes of the blocks now in the file
std::uint64_t mapped_bytes();    // bytes of mapped files now in memory

}  // namespace vitrine::server
