// SPDX-License-Identifier: Apache-2.0
// The connections that are open: for the limit on their number, for deadlines, and to end them all.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "server/auth/authenticator.h"
#include "server/config/networks.h"
#include "server/http/connection.h"

namespace vitrine {

// Thread-safe.
class ConnectionSet {
 public:
  // At most `capacity`, and `per_address` of each network_of() but for the trusted proxies'.
  ConnectionSet(std::size_t capacity, std::size_t per_address, Networks proxies = {})
      : per_address_(per_address), proxies_(std::move(proxies)), capacity_(capacity) {}

  enum class Admission { kAdmitted, kFull, kAddressFull };
  Admission add(const std::shared_ptr<Connection>& connection);
  void remove(const Connection& connection);

  // From now on it counts for `visitor`, who is behind the proxy that it came from, and will keep
  // it to itself. False where that visitor has as many as it may: then all stays as it was.
  bool count_as(Connection& connection, const std::string& visitor);

  // From now on it stays open for a caller whose token may be revoked meanwhile.
  void lasts_for(const Connection& connection, const Caller& caller);
  std::vector<Caller> lasting_callers();  // once for each connection
  // Asks those that stay open for this caller to end, as drain() does.
  void end_those_of(const Caller& caller);

  // Those that are open stay.
  void set_capacity(std::size_t capacity);

  // Closes every connection whose deadline has passed.
  void sweep();

  // Asks every connection to end: idle ones at once, others after their answer. `on_empty` is
  // called once none is left, from any thread.
  void drain(std::function<void()> on_empty);

 private:
  std::vector<std::shared_ptr<Connection>> alive();
  void count_less(const std::string& network);

  const std::size_t per_address_;
  const Networks proxies_;
  std::mutex mutex_;  // guards what follows
  std::size_t capacity_;
  bool draining_ = false;
  std::function<void()> on_empty_;
  std::unordered_map<const Connection*, std::weak_ptr<Connection>> connections_;
  std::unordered_map<std::string, std::size_t> of_network_;
  std::unordered_map<const Connection*, Caller> lasting_;
};

}  // namespace vitrine
