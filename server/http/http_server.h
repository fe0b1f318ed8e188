// SPDX-License-Identifier: Apache-2.0
// A listener and its connections.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "codec/core/expected.h"
#include "server/auth/rate_limit.h"
#include "server/config/settings.h"
#include "server/http/beast.h"
#include "server/http/bodies_in_flight.h"
#include "server/http/connection_set.h"
#include "server/http/listening.h"
#include "server/http/router.h"
#include "server/http/seats.h"
#include "server/http/send.h"
#include "server/transport/live_tls.h"

namespace vitrine {

// A connection that becomes a WebSocket. The callee owns the socket's bytes until it returns.
struct StreamCall {
  std::shared_ptr<Connection> connection;
  beast::http::request<beast::http::string_body> request;
  ModelId model;
  std::string request_id;
  std::string address;           // the visitor's
  std::optional<Caller> caller;  // nothing without a token
  bool head = false;             // the model's head comes first
};
using StreamHandler = std::function<asio::awaitable<void>(StreamCall call)>;

// Threads for what must not hold up connections.
class Workers {
 public:
  // At most `max_exports` run or wait at a time.
  Workers(unsigned threads, std::size_t max_exports);

  // The right to hand in one task for `who`, a network_of(). Keep it until the task is done.
  tl::expected<Seats::Seat, Seats::Refusal> reserve(Place place, const std::string& who);

  // Any thread for Place::kWorker, one of kDeviceThreads for Place::kDevice, of kDiskThreads for
  // Place::kDisk; for Place::kExport, equal targets run one after the other.
  asio::any_io_executor executor(Place place, std::string_view target);
  void stop() { pool_.stop(), exports_.stop(), devices_.stop(), disk_.stop(); }
  void join() { pool_.join(), exports_.join(), devices_.join(), disk_.join(); }

 private:
  static constexpr std::size_t kDeviceThreads = 4, kDeviceSeats = 32;
  static constexpr std::size_t kDiskThreads = 4, kDiskSeats = 64;

  asio::thread_pool pool_;
  asio::thread_pool exports_;
  asio::thread_pool devices_{kDeviceThreads};
  asio::thread_pool disk_{kDiskThreads};
  std::vector<asio::strand<asio::thread_pool::executor_type>> lanes_;
  const std::shared_ptr<Seats> export_seats_;  // of which one address has a quarter at most
  const std::shared_ptr<Seats> device_seats_ = std::make_shared<Seats>(kDeviceSeats, kDeviceSeats);
  const std::shared_ptr<Seats> disk_seats_ = std::make_shared<Seats>(kDiskSeats, kDiskSeats);
};

struct HttpOptions {
  std::span<const Route> routes;
  bool recorded = true;  // in the access log and the metrics
  std::size_t max_connections = 1;
  std::chrono::seconds patience{30};
  StreamHandler stream;
  std::shared_ptr<LiveTls> tls = {};  // null: without TLS
  std::size_t max_connections_per_address = SIZE_MAX;
  Networks proxies = {};
  std::uint32_t request_rate = 0;            // RateLimit
  std::uint32_t min_rate = 0;                // Pace
  std::uint64_t answer_memory = UINT64_MAX;  // BodiesInFlight
};

class HttpServer {
 public:
  HttpServer(asio::io_context& io, Services& services, Workers& workers, HttpOptions options);

  // Binds and listens, but accepts nobody yet: connections wait. Returns the port, 0 for a Unix
  // socket. Fails (kIo) with the cause.
  Expected<std::uint16_t> listen(const Endpoint& endpoint);
  void start();

  // Accepts nobody any more and ends the connections (ConnectionSet::drain).
  void drain(std::function<void()> on_empty);

  // What may change while it serves.
  void set_limits(std::size_t max_connections, std::chrono::seconds patience,
                  std::uint64_t answer_memory);

  // What the sessions use.
  const Router& router() const { return router_; }
  const HttpOptions& options() const { return options_; }
  Services& services() { return services_; }
  Workers& workers() { return workers_; }
  asio::io_context& io() { return io_; }
  RateLimit& rate_limit() { return rate_limit_; }
  BodiesInFlight& bodies() { return *bodies_; }
  ConnectionSet& connections() { return connections_; }
  Pace pace() const { return {patience_.load(std::memory_order_relaxed), options_.min_rate}; }

 private:
  asio::awaitable<bool> accept_one();
  void admit(ByteStream::Socket socket);
  void refuse(ByteStream& stream, ConnectionSet::Admission why);
  void refresh_certificate();
  asio::awaitable<void> serve(std::shared_ptr<Connection> connection);
  void sweep();
  void end_revoked();

  asio::io_context& io_;
  Services& services_;
  Workers& workers_;
  const HttpOptions options_;
  const Router router_;
  ConnectionSet connections_;
  RateLimit rate_limit_;
  const std::shared_ptr<BodiesInFlight> bodies_;
  std::atomic<std::chrono::seconds> patience_;
  asio::strand<asio::io_context::executor_type> strand_;  // of what follows
  Acceptor acceptor_;
  asio::steady_timer pause_;           // of the acceptor
  std::filesystem::path socket_file_;  // empty but for a Unix socket
  asio::steady_timer sweeper_;
  std::weak_ptr<const void> looking_;  // held by who looks for tokens that were revoked
};

}  // namespace vitrine
