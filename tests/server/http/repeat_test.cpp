// SPDX-License-Identifier: Apache-2.0
#include "server/http/repeat.h"

#include <gtest/gtest.h>

#include <new>
#include <string>
#include <vector>

namespace vitrine::server {
namespace {

TEST(Repeat, GoesOnAfterATaskThatThrew) {
  asio::io_context io;
  asio::steady_timer timer(io);
  int runs = 0;
  std::vector<std::string> faults;
  const auto task = [&] {
    if (++runs == 1) throw std::bad_alloc();
    io.stop();
  };
  asio::co_spawn(io,
                 repeat(timer, std::chrono::milliseconds(1), task,
                        [&](std::string_view fault) { faults.emplace_back(fault); }),
                 asio::detached);
  io.run();
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(faults, std::vector<std::string>{std::bad_alloc().what()});
}

TEST(KeepTrying, GoesOnAfterAnAttemptThatFailedOrThrew) {
  asio::io_context io;
  asio::steady_timer timer(io);
  int attempts = 0;
  std::vector<std::string> faults;
  const auto attempt = [&]() -> asio::awaitable<bool> {
    if (++attempts == 2) throw std::bad_alloc();
    co_return attempts > 2;
  };
  asio::co_spawn(io,
                 keep_trying(
                     timer, std::chrono::milliseconds(1), [&] { return attempts < 4; }, attempt,
                     [&](std::string_view fault) { faults.emplace_back(fault); }),
                 asio::detached);
  io.run();
  EXPECT_EQ(attempts, 4);
  EXPECT_EQ(faults, std::vector<std::string>{std::bad_alloc().what()});
}

}  // namespace
}  // namespace vitrine::server
