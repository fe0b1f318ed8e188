// SPDX-License-Identifier: Apache-2.0
// How many tasks run or wait at a time, and how many of them may be one address's.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <tl/expected.hpp>
#include <unordered_map>

namespace vitrine {

// Thread-safe. Owned by shared pointers: those who sit keep it.
class Seats : public std::enable_shared_from_this<Seats> {
 public:
  Seats(std::size_t capacity, std::size_t per_address)
      : capacity_(capacity), per_address_(per_address) {}

  using Seat = std::shared_ptr<const void>;  // is free again once nobody holds it
  enum class Refusal { kFull, kAddressFull };
  tl::expected<Seat, Refusal> take(const std::string& who);

 private:
  void leave(const std::string& who);

  const std::size_t capacity_, per_address_;
  std::mutex mutex_;  // guards what follows
  std::size_t taken_ = 0;
  std::unordered_map<std::string, std::size_t> of_address_;
};

}  // namespace vitrine
