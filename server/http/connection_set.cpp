// SPDX-License-Identifier: Apache-2.0
#include "server/http/connection_set.h"

#include <exception>
#include <utility>
#include <vector>

namespace vitrine::server {
namespace {

void close(Connection& connection) {
  boost::system::error_code ignored;
  connection.socket.close(ignored);
}

// If the connection's deadline has passed, closes the connection, or only cancels the read if a
// body is being read. Checks the deadline again, because it may have been extended since the sweep.
void close_if_expired(Connection& connection) {
  if (!connection.expired()) return;
  boost::system::error_code ignored;
  if (connection.reads_body) {
    connection.socket.cancel(ignored);
  } else {
    close(connection);
  }
}

void end(Connection& connection) {
  connection.is_draining = true;
  if (connection.on_drain) {
    connection.on_drain();
  } else if (connection.is_idle) {
    close(connection);
  }
}

// Runs `action` on the connection's strand.
void post(const std::shared_ptr<Connection>& connection, void (*action)(Connection&)) {
  asio::post(connection->socket.get_executor(), [connection, action] { action(*connection); });
}

}  // namespace

ConnectionSet::Admission ConnectionSet::add(const std::shared_ptr<Connection>& connection) {
  const bool is_proxy = proxies_.contain(connection->remote);
  const std::scoped_lock lock(mutex_);
  if (is_draining_ || connections_.size() >= capacity_) return Admission::kFull;
  connection->counted_as = network_of(connection->remote);
  std::size_t& count = of_network_[connection->counted_as];
  if (count >= per_address_ && !is_proxy) return Admission::kAddressFull;
  connections_.emplace(connection.get(), connection);
  ++count;
  return Admission::kAdmitted;
}

void ConnectionSet::remove(const Connection& connection) {
  std::function<void()> on_empty;
  {
    const std::scoped_lock lock(mutex_);
    connections_.erase(&connection);
    lasting_.erase(&connection);
    count_less(connection.counted_as);
    if (connections_.empty()) on_empty = std::exchange(on_empty_, nullptr);
  }
  if (on_empty) on_empty();
}

// Decrements the number of connections of a network. The caller must hold mutex_.
void ConnectionSet::count_less(const std::string& network) {
  const auto count = of_network_.find(network);
  if (--count->second == 0) of_network_.erase(count);
}

bool ConnectionSet::count_as(Connection& connection, const std::string& client) {
  const bool is_proxy = proxies_.contain(client);
  std::string network = network_of(client);
  const std::scoped_lock lock(mutex_);
  if (network == connection.counted_as) return true;
  const auto count = of_network_.find(network);
  if (count != of_network_.end() && count->second >= per_address_ && !is_proxy) return false;
  ++of_network_[network];
  count_less(connection.counted_as);
  connection.counted_as = std::move(network);
  return true;
}

void ConnectionSet::lasts_while(const Connection& connection, MayContinue may_continue) {
  auto check = std::make_shared<const MayContinue>(std::move(may_continue));
  const std::scoped_lock lock(mutex_);
  lasting_[&connection] = std::move(check);
}

void ConnectionSet::end_forbidden() {
  std::vector<std::pair<std::weak_ptr<Connection>, std::shared_ptr<const MayContinue>>> checks;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& [connection, may_continue] : lasting_)
      checks.emplace_back(connections_.at(connection), may_continue);
  }
  std::exception_ptr fault;  // thrown after all checks, so that it does not prevent other checks
  for (const auto& [weak, may_continue] : checks) {
    try {
      if ((*may_continue)()) continue;
      if (const auto connection = weak.lock()) post(connection, end);
    } catch (...) {
      fault = std::current_exception();
    }
  }
  if (fault) std::rethrow_exception(fault);
}

void ConnectionSet::set_capacity(std::size_t capacity, std::size_t per_address) {
  const std::scoped_lock lock(mutex_);
  capacity_ = capacity;
  per_address_ = per_address;
}

std::vector<std::shared_ptr<Connection>> ConnectionSet::alive() {
  std::vector<std::shared_ptr<Connection>> all;
  const std::scoped_lock lock(mutex_);
  all.reserve(connections_.size());
  for (const auto& [key, weak] : connections_) {
    if (auto connection = weak.lock()) all.push_back(std::move(connection));
  }
  return all;
}

void ConnectionSet::sweep() {
  for (const auto& connection : alive()) {
    if (connection->expired()) post(connection, close_if_expired);
  }
}

void ConnectionSet::drain(std::function<void()> on_empty) {
  {
    const std::scoped_lock lock(mutex_);
    is_draining_ = true;
    if (!connections_.empty()) on_empty_ = std::exchange(on_empty, nullptr);
  }
  if (on_empty) on_empty();
  for (const auto& connection : alive())
    post(connection, end);
}

}  // namespace vitrine::server
