// SPDX-License-Identifier: Apache-2.0
// The set of open connections: limits their number, enforces their deadlines, and ends them at
// shutdown.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "server/config/networks.h"
#include "server/http/connection.h"

namespace vitrine::server {

// Thread-safe.
class ConnectionSet {
 public:
  // Admits `capacity` connections in total, and `per_address` connections of each network
  // (network_of()). Trusted proxies are exempt from the limit per network.
  ConnectionSet(std::size_t capacity, std::size_t per_address, Networks proxies = {})
      : proxies_(std::move(proxies)), capacity_(capacity), per_address_(per_address) {}

  enum class Admission { kAdmitted, kFull, kAddressFull };
  Admission add(const std::shared_ptr<Connection>& connection);
  void remove(const Connection& connection);

  // Counts a connection from a proxy towards the limit of `client`, the address behind the proxy.
  // Call this only for a connection that serves no other clients. If the client has reached its
  // limit, returns false and changes nothing.
  bool count_as(Connection& connection, const std::string& client);

  // Returns whether a connection may continue. Thread-safe; may block.
  using MayContinue = std::function<bool()>;
  // Registers a long-lived connection, for which end_forbidden() calls `may_continue`.
  void lasts_while(const Connection& connection, MayContinue may_continue);
  // Calls each registered `may_continue`. If it returns false, asks the connection to end, as
  // drain() does. Blocks.
  void end_forbidden();

  // Changes the limits for new connections. Open connections stay open.
  void set_capacity(std::size_t capacity, std::size_t per_address);

  // Closes every connection whose deadline has passed. If such a connection is reading a body, only
  // cancels the read (Connection::reads_body).
  void sweep();

  // Asks every connection to end: idle ones at once, others after their current response. Calls
  // `on_empty` on any thread once no connection is left.
  void drain(std::function<void()> on_empty);

 private:
  std::vector<std::shared_ptr<Connection>> alive();
  void count_less(const std::string& network);

  const Networks proxies_;
  std::mutex mutex_;  // guards the members below
  std::size_t capacity_, per_address_;
  bool is_draining_ = false;
  std::function<void()> on_empty_;
  std::unordered_map<const Connection*, std::weak_ptr<Connection>> connections_;
  std::unordered_map<std::string, std::size_t> of_network_;
  std::unordered_map<const Connection*, std::shared_ptr<const MayContinue>> lasting_;
};

}  // namespace vitrine::server
