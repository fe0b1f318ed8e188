// SPDX-License-Identifier: Apache-2.0
#include "server/log/line_batch.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace vitrine::server {
namespace {

std::string read_all(int descriptor) {
  std::string text;
  char piece[4096];
  for (ssize_t count; (count = ::read(descriptor, piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(count));
  ::close(descriptor);
  return text;
}

// write(2) to a full pipe waits. If a signal interrupts the wait, write(2) returns the number of
// bytes written so far.
TEST(LineBatch, AWriteThatIsInterruptedTearsNoLine) {
  struct sigaction action {};
  action.sa_handler = [](int) {};  // no SA_RESTART, so that write(2) returns after a signal
  ASSERT_EQ(::sigaction(SIGUSR2, &action, nullptr), 0);
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ASSERT_GT(::fcntl(ends[1], F_SETPIPE_SZ, 4096), 0);
  const std::string lines = std::string(20'000, 'x') + "\n" + std::string(20'000, 'y') + "\n";
  std::thread writer([&] {
    LineBatch batch;
    batch.add(lines, ends[1]);
    batch.flush(ends[1]);
    ::close(ends[1]);
  });
  pollfd written = {.fd = ends[0], .events = POLLIN, .revents = 0};
  ASSERT_EQ(::poll(&written, 1, 20'000), 1);
  ::pthread_kill(writer.native_handle(), SIGUSR2);
  EXPECT_TRUE(read_all(ends[0]) == lines);
  writer.join();
}

}  // namespace
}  // namespace vitrine::server
