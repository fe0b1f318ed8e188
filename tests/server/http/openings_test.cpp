// SPDX-License-Identifier: Apache-2.0
// Tests how workers open files for the requests that need them.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <optional>
#include <stdexcept>

#include "server/http/workers.h"

namespace vitrine::server {
namespace {

class RunningOpenings : public ::testing::Test {
 protected:
  ~RunningOpenings() override { end(); }

  // Sends a request that needs the file.
  void ask(const std::string& name, std::function<bool()> open) {
    auto request = [this, opening = Opening{name, std::move(open)}]() -> asio::awaitable<void> {
      co_await workers->open("somebody", opening);
      ++answered;
    };
    asio::co_spawn(asio::make_strand(io), std::move(request), asio::detached);
  }
  void run_what_is_ready() {
    while (io.poll() > 0) {
    }
  }
  void end() {
    if (!workers) return;
    workers->stop();
    workers->join();
    workers.reset();
  }

  asio::io_context io;
  std::optional<Workers> workers = std::optional<Workers>(std::in_place, WorkerOptions{});
  int answered = 0;
};

TEST_F(RunningOpenings, RequestsForAFileFindItOpenBehindTheFirst) {
  std::atomic<bool> is_open = false;
  std::atomic<int> found_closed = 0;
  std::promise<void> all_asked;
  const std::shared_future<void> may_open = all_asked.get_future().share();
  for (int i = 0; i < 5; ++i) {
    ask("a file", [&, may_open] {
      if (is_open) return true;
      ++found_closed;
      may_open.wait();
      is_open = true;
      return true;
    });
  }
  run_what_is_ready();
  all_asked.set_value();
  io.run();
  EXPECT_EQ(found_closed, 1);
  EXPECT_EQ(answered, 5);
}

TEST_F(RunningOpenings, AFileThatCannotBeOpenedIsTriedOnceForAllThatWait) {
  for (const bool throws : {false, true}) {
    std::atomic<int> attempts = 0;
    std::promise<void> all_asked;
    const std::shared_future<void> may_open = all_asked.get_future().share();
    answered = 0;
    for (int i = 0; i < 5; ++i) {
      ask("a file", [&, may_open] {
        ++attempts;
        may_open.wait();
        if (throws) throw std::runtime_error("no memory");
        return false;
      });
    }
    run_what_is_ready();
    all_asked.set_value();
    io.run();
    io.restart();
    EXPECT_EQ(attempts, 1);
    EXPECT_EQ(answered, 5);
  }
}

TEST_F(RunningOpenings, AFailureConcernsNeitherOtherFilesNorLaterRequests) {
  std::atomic<int> attempts = 0;
  const auto fails = [&] {
    ++attempts;
    return false;
  };
  ask("a file", fails);
  ask("another file", fails);
  io.run();
  io.restart();
  EXPECT_EQ(attempts, 2);
  ask("a file", fails);
  io.run();
  EXPECT_EQ(attempts, 3);
}

TEST_F(RunningOpenings, TheServerCanStopWhileFilesAreOpenedAndRequestsWait) {
  std::promise<void> stopping, first_opens;
  const std::shared_future<void> may_open = stopping.get_future().share();
  std::atomic<int> opened = 0;
  for (const char* name : {"a file", "a file", "another file"}) {
    ask(name, [&, may_open] {
      if (++opened == 1) first_opens.set_value();
      may_open.wait();
      return true;
    });
  }
  run_what_is_ready();
  first_opens.get_future().wait();
  io.stop();
  workers->stop();
  stopping.set_value();
  end();
  EXPECT_EQ(answered, 0);
}

}  // namespace
}  // namespace vitrine::server
