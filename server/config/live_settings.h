// SPDX-License-Identifier: Apache-2.0
// Holds the settings in force, which are replaced as a whole. A reader keeps the settings that it
// got, even after they are replaced.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "server/config/settings.h"

namespace vitrine::server {

// Thread-safe.
class LiveSettings {
 public:
  explicit LiveSettings(Settings settings)
      : settings_(std::make_shared<const Settings>(std::move(settings))) {}

  std::shared_ptr<const Settings> get() const {
    const std::scoped_lock lock(mutex_);
    return settings_;
  }
  void replace(Settings settings) {
    auto fresh = std::make_shared<const Settings>(std::move(settings));
    const std::scoped_lock lock(mutex_);
    settings_.swap(fresh);
  }

 private:
  mutable std::mutex mutex_;  // guards the members below
  std::shared_ptr<const Settings> settings_;
};

}  // namespace vitrine::server
