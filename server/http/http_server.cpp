// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include <sys/socket.h>

#include "server/http/repeat.h"
#include "server/http/session.h"

namespace vitrine::server {
namespace {

// Interval between two calls of sweep(). A long-lived connection that may no longer continue must
// end within one second, which includes this interval and the time for the check.
constexpr std::chrono::milliseconds kSweepInterval{500};

// Sends `text` without waiting for the peer. The text is lost if the socket cannot accept it at
// once.
void answer_at_once(ByteStream& stream, std::string_view text) {
  static_cast<void>(
      ::send(stream.native_handle(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
}

}  // namespace

HttpServer::HttpServer(asio::io_context& io, HttpDependencies dependencies, HttpOptions options)
    : io_(io),
      dependencies_(dependencies),
      options_(std::move(options)),
      router_(options_.routes, options_.parameters),
      connections_(options_.max_connections, options_.max_connections_per_address,
                   options_.proxies),
      rate_limit_(options_.request_rate),
      bodies_(std::make_shared<BodiesInFlight>(options_.answer_memory)),
      idle_timeout_(options_.idle_timeout),
      strand_(asio::make_strand(io)),
      acceptor_(strand_),
      pause_(strand_),
      sweeper_(strand_) {}

Expected<std::uint16_t> HttpServer::listen(const Endpoint& endpoint) {
  socket_file_ = endpoint.path;
  return server::listen(acceptor_, endpoint);
}

void HttpServer::set_limits(const Limits& limits) {
  connections_.set_capacity(limits.max_connections, limits.per_address);
  bodies_->set_capacity(limits.answer_memory);
  idle_timeout_ = limits.idle_timeout;
}

bool HttpServer::may_log_refusal(std::string_view address) {
  if (log_ration_.take(network_of(address)).count() == 0) return true;
  dependencies_.metrics.refusals_not_logged.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void HttpServer::start() {
  const auto failed = [this](std::string_view fault) {
    dependencies_.events.event(Severity::kError, fault);
  };
  // Accepting fails if descriptors or memory have run out. The server then tries again, because
  // connections free both when they end.
  asio::co_spawn(strand_,
                 keep_trying(
                     pause_, std::chrono::milliseconds(100), [this] { return acceptor_.is_open(); },
                     [this] { return accept_one(); }, failed),
                 asio::detached);
  asio::co_spawn(strand_,
                 repeat(
                     sweeper_, kSweepInterval, [this] { sweep(); }, failed),
                 asio::detached);
}

// Accepts one connection and starts to serve it. Returns false if no connection was accepted.
asio::awaitable<bool> HttpServer::accept_one() {
  auto [error, socket] = co_await acceptor_.async_accept(asio::make_strand(io_), kNoThrow);
  if (!error) admit(std::move(socket));
  co_return !error;
}

void HttpServer::admit(ByteStream::Socket socket) {
  auto connection = std::make_shared<Connection>(std::move(socket));
  const auto admission = connections_.add(connection);
  if (admission != ConnectionSet::Admission::kAdmitted)
    return refuse(connection->socket, admission);
  try {
    asio::co_spawn(connection->socket.get_executor(), serve(connection), asio::detached);
  } catch (...) {
    connections_.remove(*connection);
    throw;
  }
}

void HttpServer::refuse(ByteStream& stream, ConnectionSet::Admission why) {
  dependencies_.metrics.refused.fetch_add(1, std::memory_order_relaxed);
  if (options_.tls) return;  // a response would need a TLS handshake first
  answer_at_once(stream, why == ConnectionSet::Admission::kFull
                             ? "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 5\r\n"
                               "Content-Length: 0\r\nConnection: close\r\n\r\n"
                             : "HTTP/1.1 429 Too Many Requests\r\nRetry-After: 5\r\n"
                               "Content-Length: 0\r\nConnection: close\r\n\r\n");
}

asio::awaitable<void> HttpServer::serve(std::shared_ptr<Connection> connection) {
  dependencies_.metrics.connections.fetch_add(1, std::memory_order_relaxed);
  try {
    co_await run_session(connection, *this);
  } catch (const std::exception& fault) {  // for example std::bad_alloc; ends only this connection
    dependencies_.events.event(Severity::kError, fault.what());
  }
  dependencies_.metrics.connections.fetch_sub(1, std::memory_order_relaxed);
  connections_.remove(*connection);
}

void HttpServer::sweep() {
  connections_.sweep();
  refresh_certificate();
  end_forbidden();
}

void HttpServer::lasts_while(const Connection& connection, const std::optional<Caller>& caller,
                             ConnectionSet::MayContinue may_continue) {
  connections_.lasts_while(connection, [this, caller, may_continue = std::move(may_continue)] {
    const auto in_force = caller ? dependencies_.tokens.is_in_force(*caller) : true;
    const bool is_revoked = in_force && !*in_force;
    return !is_revoked && may_continue();
  });
}

// Ends long-lived connections that may no longer continue. Checks them on a worker thread, because
// reading the catalogue may block. Only one check runs at a time.
void HttpServer::end_forbidden() {
  if (!permission_check_.expired()) return;
  const auto check = std::make_shared<int>();
  permission_check_ = check;
  asio::post(workers().checks(), [this, check] {
    try {
      connections_.end_forbidden();
    } catch (const std::exception& fault) {
      dependencies_.events.event(Severity::kError, fault.what());
    }
  });
}

void HttpServer::refresh_certificate() {
  if (!options_.tls) return;
  const auto refreshed = options_.tls->refresh();
  if (!refreshed) {
    dependencies_.events.event(Severity::kError,
                               "the certificate stays as it was: " + refreshed.error().message);
  } else if (*refreshed) {
    dependencies_.events.event(Severity::kInfo, "certificate read again");
  }
}

void HttpServer::drain(std::function<void()> on_empty) {
  asio::post(strand_, [this, on_empty = std::move(on_empty)]() mutable {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    std::error_code gone;
    if (!socket_file_.empty()) std::filesystem::remove(socket_file_, gone);
    connections_.drain(std::move(on_empty));
  });
}

}  // namespace vitrine::server
