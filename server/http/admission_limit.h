// SPDX-License-Identifier: Apache-2.0
// Limits how many tasks may run or wait at the same time, in total (`capacity`) and per address. If
// the limit per address is smaller than the capacity, the last quarter of the capacity is only for
// addresses that have no admitted task.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <tl/expected.hpp>
#include <unordered_map>

namespace vitrine::server {

// Thread-safe. Must be owned by a shared pointer, because each pass keeps the limit alive.
class AdmissionLimit : public std::enable_shared_from_this<AdmissionLimit> {
 public:
  AdmissionLimit(std::size_t capacity, std::size_t per_address)
      : capacity_(capacity), per_address_(per_address) {}

  // Counts one admitted task until the last copy of the pass is destroyed.
  using Pass = std::shared_ptr<const void>;
  enum class Refusal { kFull, kAddressFull };
  // Admits one task for `address`, or returns which of the two limits is reached.
  tl::expected<Pass, Refusal> admit(const std::string& address);

 private:
  void leave(const std::string& address);

  const std::size_t capacity_, per_address_;
  std::mutex mutex_;  // guards the members below
  std::size_t admitted_ = 0;
  std::unordered_map<std::string, std::size_t> of_address_;
};

}  // namespace vitrine::server
