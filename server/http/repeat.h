// SPDX-License-Identifier: Apache-2.0
// Coroutines that repeat a task of the server.
#pragma once

#include <functional>
#include <string_view>

#include "server/http/beast.h"

namespace vitrine::server {

// Runs `task` after each `period` until the timer is cancelled. If the task throws (for example,
// out of memory), calls `failed` and continues.
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

// Calls `attempt` repeatedly as long as `may_continue` returns true. If an attempt returns false or
// throws, waits for `pause` before the next attempt. If an attempt throws, also calls `failed`.
inline asio::awaitable<void> keep_trying(asio::steady_timer& timer,
                                         asio::steady_timer::duration pause,
                                         std::function<bool()> may_continue,
                                         std::function<asio::awaitable<bool>()> attempt,
                                         std::function<void(std::string_view fault)> failed) {
  for (bool is_well = true; may_continue();) {
    try {
      timer.expires_after(pause);
      if (!is_well) co_await timer.async_wait(kNoThrow);
      is_well = false;
      is_well = co_await attempt();
    } catch (const std::exception& fault) {
      failed(fault.what());
    }
  }
}

}  // namespace vitrine::server
