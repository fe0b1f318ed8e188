// SPDX-License-Identifier: Apache-2.0
// The HTTP/1.1 server: a listener, its connections, and the routes that it serves.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "codec/core/expected.h"
#include "server/auth/authenticator.h"
#include "server/auth/rate_limit.h"
#include "server/config/settings.h"
#include "server/http/beast.h"
#include "server/http/bodies_in_flight.h"
#include "server/http/connection_set.h"
#include "server/http/listening.h"
#include "server/http/send.h"
#include "server/http/workers.h"
#include "server/log/log.h"
#include "server/messages/router.h"
#include "server/metrics/metrics.h"
#include "server/transport/live_tls.h"

namespace vitrine::server {

struct HttpOptions {
  std::vector<Route> routes;
  std::span<const ParameterPattern> parameters;  // the parameters in the routes' paths
  // Whether to answer requests with this value of the Host field; empty: always. Must be
  // thread-safe.
  std::function<bool(std::string_view host)> answers_to = {};
  // Whether pages of this origin may send any request and read its response (CORS); empty: never.
  // Must be thread-safe.
  std::function<bool(std::string_view origin)> trusts_origin = {};
  // Whether pages of all origins may read responses for which no token is needed.
  bool is_read_by_pages = true;
  bool is_recorded = true;          // whether requests appear in the access log and the metrics
  bool shortens_addresses = false;  // whether the logs name networks instead of addresses
  std::size_t max_connections = 1;
  std::chrono::seconds idle_timeout{30};
  // Interval between two sweeps. A connection that may no longer continue must end within one
  // second, which includes this interval, the age of cached data (100 ms) and the check.
  std::chrono::milliseconds sweep_interval{500};
  std::shared_ptr<LiveTls> tls = {};  // null if the server does not use TLS
  std::size_t max_connections_per_address = SIZE_MAX;
  Networks proxies = {};
  std::uint32_t request_rate = 0;  // requests per second; see RateLimit
  std::uint32_t min_rate = 0;      // bytes per second; see Pace
  // Minimum rate for bodies that BodiesInFlight counts, because they occupy memory until they are
  // received. A tenth of it applies to modest bodies, so that slow phones receive them. If
  // `min_rate` is larger, it applies instead; if it is 0, there is no minimum.
  std::uint32_t min_memory_rate = 20'000;
  std::uint64_t answer_memory = UINT64_MAX;  // limit in bytes; see BodiesInFlight
};

// The parts of the daemon that the server uses. They must be thread-safe and outlive the server.
struct HttpDependencies {
  Authenticator& tokens;
  Workers& workers;
  Metrics& metrics;
  const Log& access_log;
  const Log& events;
};

class HttpServer {
 public:
  HttpServer(asio::io_context& io, HttpDependencies dependencies, HttpOptions options);

  // Binds and listens. No connection is accepted before start(). Returns the port, or 0 for a Unix
  // socket. Fails (kIo) with the cause.
  Expected<std::uint16_t> listen(const Endpoint& endpoint);
  void start();

  // Stops accepting connections and ends the open ones (ConnectionSet::drain).
  void drain(std::function<void()> on_empty);

  // Closes the connections whose deadline has passed, and checks the long-lived ones (lasts_while)
  // in the background. start() makes this call periodic. Thread-safe.
  void sweep();

  // Limits that may change while the server runs; see HttpOptions.
  struct Limits {
    std::size_t max_connections = 1, per_address = SIZE_MAX;
    std::chrono::seconds idle_timeout{30};
    std::uint64_t answer_memory = UINT64_MAX;
  };
  void set_limits(const Limits& limits);

  // Only sessions call the functions below.
  const Router& router() const { return router_; }
  const HttpOptions& options() const { return options_; }
  const HttpDependencies& dependencies() const { return dependencies_; }
  Workers& workers() { return dependencies_.workers; }
  asio::io_context& io() { return io_; }
  RateLimit& rate_limit() { return rate_limit_; }
  // Returns whether one more refused request of this address may be logged. If not, counts the
  // request as not logged.
  bool may_log_refusal(std::string_view address);
  // The same for a response from memory, which no rate limit has counted.
  bool may_log_answer(std::string_view address);
  BodiesInFlight& bodies() { return *bodies_; }
  ConnectionSet& connections() { return connections_; }
  // Registers a long-lived response. The response ends within a second after the token of `caller`
  // was revoked, or after `may_continue` returned false.
  void lasts_while(const Connection& connection, const std::optional<Caller>& caller,
                   ConnectionSet::MayContinue may_continue);
  Pace pace() const { return {idle_timeout_.load(std::memory_order_relaxed), options_.min_rate}; }
  // Returns the limits for a response with this body.
  Pace pace_of(const Body& body) const {
    Pace result = pace();
    if (result.min_rate == 0 || !BodiesInFlight::counts(body)) return result;
    const std::uint32_t rate = options_.min_memory_rate;
    result.min_rate = std::max(result.min_rate, bodies_->is_modest(body) ? rate / 10 : rate);
    return result;
  }

 private:
  asio::awaitable<bool> accept_one();
  void admit(ByteStream::Socket socket);
  void refuse(ByteStream& stream, ConnectionSet::Admission why);
  void refresh_certificate();
  asio::awaitable<void> serve(std::shared_ptr<Connection> connection);
  void end_forbidden();

  asio::io_context& io_;
  const HttpDependencies dependencies_;
  const HttpOptions options_;
  const Router router_;
  ConnectionSet connections_;
  RateLimit rate_limit_;
  // Number of refusals that are logged per address and second.
  static constexpr std::uint32_t kLoggedRefusals = 10;
  RateLimit log_ration_{kLoggedRefusals};
  RateLimit answer_log_ration_{options_.request_rate};
  const std::shared_ptr<BodiesInFlight> bodies_;
  std::atomic<std::chrono::seconds> idle_timeout_;
  asio::strand<asio::io_context::executor_type> strand_;  // guards the members below
  Acceptor acceptor_;
  asio::steady_timer pause_;           // timer that delays the next accept after an error
  std::filesystem::path socket_file_;  // empty unless the server listens on a Unix socket
  asio::steady_timer sweeper_;
  // Expired unless a worker is checking which connections may continue.
  std::weak_ptr<const void> permission_check_;
};

}  // namespace vitrine::server
