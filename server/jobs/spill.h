// SPDX-License-Identifier: Apache-2.0
// Out of core: what a process allocates beyond a share of the memory that it may hold lies in a
// file without a name, mapped, and leaves memory as soon as the process holds too much. Programs
// that link this have it behind operator new, so no algorithm knows and no result depends on it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "codec/core/expected.h"

namespace vitrine {

struct SpillOptions {
  std::filesystem::path folder = {};  // for the file: on a disk with room; empty: no spilling
  std::uint64_t resident_bytes = 2ull << 30;  // of the process, at most; more only for small blocks
  // A file mapped read-only, from its start: its pages, too, leave memory.
  std::span<const std::uint8_t> input = {};
};

// Begins to spill, until the process ends. Call it in a process of one thread, once, and
// start_trimming() right after, where threads may be started; what happens between the two may take
// away the right to open files. The file takes at most half of the room that the disk has, 64 GiB
// and what files may have (RLIMIT_FSIZE), as address space from the start; beyond it, and on a disk
// that cannot hold or map such a file, memory is used. Fails (kIo) where no file can be made.
// Where others fill the disk meanwhile, the process ends by SIGBUS.
Expected<void> open_spill(const SpillOptions& options);
void start_trimming();

// All 0 where there is no spilling.
std::uint64_t spill_capacity();  // bytes of address space
std::uint64_t spilled_bytes();   // that lie in the file now
std::uint64_t mapped_bytes();    // of files that the process holds in memory now

}  // namespace vitrine
