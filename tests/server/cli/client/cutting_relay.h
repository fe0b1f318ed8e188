// SPDX-License-Identifier: Apache-2.0
// A relay between a client and a server. It cuts off the first connection.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace vitrine::test {

class CuttingRelay {
 public:
  // Forwards connections to port `port` of 127.0.0.1. Cuts off the first connection after the
  // server has sent `bytes` bytes.
  CuttingRelay(std::uint16_t port, std::size_t bytes);
  ~CuttingRelay();
  CuttingRelay(const CuttingRelay&) = delete;
  CuttingRelay& operator=(const CuttingRelay&) = delete;

  std::uint16_t port() const { return port_; }
  int connections() const { return connections_; }

 private:
  void run();
  void relay(int client, std::size_t limit);

  std::uint16_t server_port_, port_ = 0;
  std::size_t bytes_;
  int listener_;
  std::atomic<int> connections_{0};
  std::thread thread_;
};

}  // namespace vitrine::test
