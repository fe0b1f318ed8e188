// SPDX-License-Identifier: Apache-2.0
// Holds the current settings. replace() replaces all of them at once, but never frees the old
// settings, so that references to them stay valid. Reloads are rare, so old settings need little
// memory.
#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <utility>

#include "server/config/settings.h"

namespace vitrine::server {

// Thread-safe.
class LiveSettings {
 public:
  explicit LiveSettings(Settings settings) { replace(std::move(settings)); }

  // Does not lock a mutex, because every request calls this function. The reference is valid as
  // long as this object.
  const Settings& get() const { return *current_.load(std::memory_order_acquire); }
  void replace(Settings settings) {
    const std::scoped_lock lock(mutex_);
    all_.push_back(std::move(settings));
    current_.store(&all_.back(), std::memory_order_release);
  }

 private:
  std::mutex mutex_;                      // guards `all_`
  std::deque<Settings> all_;              // all settings since the start of the daemon
  std::atomic<const Settings*> current_;  // the last element of `all_`
};

}  // namespace vitrine::server
