// SPDX-License-Identifier: Apache-2.0
#include "server/transport/least_round_trip.h"

// Includes <linux/tcp.h>, because glibc's <netinet/tcp.h> lacks tcpi_min_rtt. The two headers
// cannot be included in the same file.
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

namespace vitrine::server {

std::optional<std::chrono::microseconds> least_round_trip(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  constexpr std::size_t kEnough = offsetof(tcp_info, tcpi_min_rtt) + sizeof info.tcpi_min_rtt;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 || size < kEnough)
    return std::nullopt;
  // UINT32_MAX means that the kernel has not measured a round trip yet.
  if (info.tcpi_min_rtt == UINT32_MAX) return std::nullopt;
  return std::chrono::microseconds(info.tcpi_min_rtt);
}

}  // namespace vitrine::server
