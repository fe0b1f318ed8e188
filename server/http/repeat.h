// SPDX-License-Identifier: Apache-2.0
// What a server does again and again for as long as it lives.
#pragma once

#include <functional>
#include <string_view>

#include "server/http/beast.h"

namespace vitrine {

// Runs `task` after each `period` until the timer is cancelled. What it throws (memory has run out)
// is told to `failed`, and it runs again in its time.
inline asio::awaitable<void> repeat(asio::steady_timer& timer, asio::steady_timer::duration period,
                                    std::function<void()> task,
                                    std::function<void(std::string_view fault)> failed) {
  for (;;) {
    try {
      timer.expires_after(period);
      const auto [error] = co_await timer.async_wait(kNoThrow);
      if (error) co_return;
      task();
    } catch (const std::exception& fault) {
      failed(fault.what());
    }
  }
}

}  // namespace vitrine
