// SPDX-License-Identifier: Apache-2.0
// Counts the daemon's busy streams. A stream is busy while it has bytes in flight. Thread-safe.
#pragma once

#include <atomic>
#include <cstddef>

namespace vitrine::server {

class BusyStreams {
 public:
  std::size_t count() const { return count_.load(std::memory_order_relaxed); }

 private:
  friend class BusyMark;
  std::atomic<std::size_t> count_{0};
};

// Adds one stream to the count while the stream is busy. The destructor removes it from the count.
// `streams` must outlive the mark.
class BusyMark {
 public:
  explicit BusyMark(BusyStreams& streams) : streams_(streams) {}
  ~BusyMark() { set(false); }
  BusyMark(const BusyMark&) = delete;
  BusyMark& operator=(const BusyMark&) = delete;

  void set(bool is_busy) {
    if (is_busy == is_busy_) return;
    is_busy_ = is_busy;
    is_busy ? streams_.count_.fetch_add(1, std::memory_order_relaxed)
            : streams_.count_.fetch_sub(1, std::memory_order_relaxed);
  }

 private:
  BusyStreams& streams_;
  bool is_busy_ = false;
};

}  // namespace vitrine::server
