// SPDX-License-Identifier: Apache-2.0
// The settings in force: replaced as a whole, while others go on with those that they have.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "server/config/settings.h"

namespace vitrine {

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
  mutable std::mutex mutex_;  // guards what follows
  std::shared_ptr<const Settings> settings_;
};

}  // namespace vitrine
