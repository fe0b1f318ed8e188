// SPDX-License-Identifier: Apache-2.0
#include "cutting_relay.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "support/process/loopback.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

// Forwards the available bytes, but at most `limit`. Returns the number of forwarded bytes, or 0 at
// the end of the stream.
std::size_t pass(int from, int to, std::size_t limit) {
  char bytes[4096];
  const ssize_t count = ::recv(from, bytes, std::min(limit, sizeof bytes), 0);
  if (count <= 0) return 0;
  const auto size = static_cast<std::size_t>(count);
  return ::send(to, bytes, size, MSG_NOSIGNAL) == count ? size : 0;
}

}  // namespace

CuttingRelay::CuttingRelay(std::uint16_t port, std::size_t bytes)
    : server_port_(port), bytes_(bytes), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size);
  ::listen(listener_, 8);
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

CuttingRelay::~CuttingRelay() {
  ::shutdown(listener_, SHUT_RDWR);
  thread_.join();
  ::close(listener_);
}

void CuttingRelay::run() {
  for (;;) {
    const int client = ::accept(listener_, nullptr, nullptr);
    if (client < 0) return;
    relay(client, connections_++ == 0 ? bytes_ : kNoLimit);
    ::close(client);
  }
}

void CuttingRelay::relay(int client, std::size_t limit) {
  const FileDescriptor connection = connect_to(server_port_);
  const int server = connection.get();
  bool open = true;
  std::size_t passed = 0;
  while (open && passed < limit) {
    pollfd ends[] = {{client, POLLIN, 0}, {server, POLLIN, 0}};
    if (::poll(ends, 2, 20'000) <= 0) break;
    if (ends[0].revents != 0) open = pass(client, server, kNoLimit) > 0;
    if (!open || ends[1].revents == 0) continue;
    const std::size_t count = pass(server, client, limit - passed);
    open = count > 0;
    passed += count;
  }
}

}  // namespace vitrine::test
