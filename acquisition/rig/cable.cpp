// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/cable.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace vitrine::acquisition::rig {

Cable::Cable(std::function<void()> pull, std::function<void()> put_back)
    : pull_(std::move(pull)), put_back_(std::move(put_back)) {}

void Cable::pull() {
  hand_ = {};
  hand_ = std::jthread([this](const std::stop_token& stop) {
    pull_();
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any stopped;
    stopped.wait_for(lock, stop, kUnplugged, [] { return false; });
    if (!stop.stop_requested()) put_back_();
  });
}

}  // namespace vitrine::acquisition::rig
