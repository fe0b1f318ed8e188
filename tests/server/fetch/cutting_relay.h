// SPDX-License-Identifier: Apache-2.0
// Stands between client and server and cuts the first connection off.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace vitrine::test {

class CuttingRelay {
 public:
  // To `port` of 127.0.0.1. The first connection ends once `bytes` have come from the server.
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
