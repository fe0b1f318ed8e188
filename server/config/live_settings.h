// SPDX-License-Identifier: Apache-2.0
// Holds the settings in force, which are replaced as a whole. Replaced settings stay valid for
// their readers; reloads are rare, so all of them fit in memory.
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

  // Takes no lock, because every request calls it. The reference is valid as long as this object.
  const Settings& get() const { return *current_.load(std::memory_order_acquire); }
  void replace(Settings settings) {
    const std::scoped_lock lock(mutex_);
    all_.push_back(std::move(settings));
    current_.store(&all_.back(), std::memory_order_release);
  }

 private:
  std::mutex mutex_;                      // guards `all_`
  std::deque<Settings> all_;              // all settings that were ever in force
  std::atomic<const Settings*> current_;  // the last of `all_`
};

}  // namespace vitrine::server
