// SPDX-License-Identifier: Apache-2.0
// Memory for what is small where the system refuses any. What ends a call in order allocates, too,
// in places that cannot fail (nlohmann-json in destructors, Asio where it makes a strand): without
// this the daemon would crash there. What is large is refused as ever, and its call with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace vitrine {

// Thread-safe. Works before main() where it is constinit.
class SpareMemory {
 public:
  static constexpr std::size_t kMost = 64 * 1024;  // bytes of a block

  // Null where that is more, or there is no room.
  void* take(std::size_t bytes) noexcept;
  // False where it was not taken here.
  bool give_back(void* block) noexcept;

 private:
  static constexpr std::size_t kUnit = 256, kUnits = 4096;  // 1 MiB

  std::mutex mutex_;
  std::array<std::uint16_t, kUnits> lengths_{};  // in units, at the first of each block
  alignas(std::max_align_t) std::array<std::byte, kUnit * kUnits> bytes_{};
};

}  // namespace vitrine
