// SPDX-License-Identifier: Apache-2.0
// A reserve for small allocations while the system is out of memory. Some code that handles lack of
// memory must itself allocate and cannot fail: the destructors of nlohmann-json, and Asio when it
// creates a strand. Without the reserve, this code would crash the daemon. Large allocations still
// fail, and so do the requests that need them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace vitrine::server {

// Thread-safe. A constinit object works before main().
class SpareMemory {
 public:
  static constexpr std::size_t kMost = 64 * 1024;  // largest block in bytes

  // Allocates a block. Returns null if `bytes` is greater than kMost or no space is left.
  void* take(std::size_t bytes) noexcept;
  // Frees a block. Returns false if it is not part of the reserve.
  bool give_back(void* block) noexcept;

 private:
  static constexpr std::size_t kUnit = 256, kUnits = 4096;  // 1 MiB in total

  std::mutex mutex_;
  // The length of each block in units, at the index of the block's first unit.
  std::array<std::uint16_t, kUnits> lengths_{};
  alignas(std::max_align_t) std::array<std::byte, kUnit * kUnits> bytes_{};
};

}  // namespace vitrine::server
