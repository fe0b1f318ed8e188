// SPDX-License-Identifier: Apache-2.0
// How many of a daemon's streams have something on their way. Thread-safe.
#pragma once

#include <atomic>
#include <cstddef>

namespace vitrine {

class Crowd {
 public:
  std::size_t busy() const { return busy_.load(std::memory_order_relaxed); }

 private:
  friend class CrowdMember;
  std::atomic<std::size_t> busy_{0};
};

// One stream, as long as it lives; the crowd outlives it.
class CrowdMember {
 public:
  explicit CrowdMember(Crowd& crowd) : crowd_(crowd) {}
  ~CrowdMember() { set_busy(false); }
  CrowdMember(const CrowdMember&) = delete;
  CrowdMember& operator=(const CrowdMember&) = delete;

  void set_busy(bool busy) {
    if (busy == is_busy_) return;
    is_busy_ = busy;
    busy ? crowd_.busy_.fetch_add(1, std::memory_order_relaxed)
         : crowd_.busy_.fetch_sub(1, std::memory_order_relaxed);
  }

 private:
  Crowd& crowd_;
  bool is_busy_ = false;
};

}  // namespace vitrine
