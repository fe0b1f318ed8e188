// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include <sys/socket.h>

#include "server/http/repeat.h"
#include "server/http/services.h"
#include "server/http/session.h"

namespace vitrine {
namespace {

constexpr std::size_t kLanes = 16;

// Best effort: nobody waits for the peer to take it.
void answer_at_once(ByteStream& stream, std::string_view text) {
  static_cast<void>(
      ::send(stream.native_handle(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
}

constexpr std::size_t kElsewhere = 3 * Services::kMostElsewhere;  // threads, for all its kinds

// One address may hold a quarter of them: nobody locks the others out.
std::shared_ptr<Seats> shared_seats(std::size_t count) {
  return std::make_shared<Seats>(count, (count + 3) / 4);
}

}  // namespace

Workers::Workers(unsigned threads, std::size_t max_exports)
    : pool_(threads + kElsewhere), exports_(threads), export_seats_(shared_seats(max_exports)) {
  for (std::size_t i = 0; i < kLanes; ++i)
    lanes_.push_back(asio::make_strand(exports_.executor()));
}

asio::any_io_executor Workers::executor(Place place, std::string_view target) {
  if (place == Place::kDevice) return devices_.executor();
  if (place == Place::kDisk) return disk_.executor();
  if (place != Place::kExport) return pool_.executor();
  return lanes_[std::hash<std::string_view>{}(target) % kLanes];
}

tl::expected<Seats::Seat, Seats::Refusal> Workers::reserve(Place place, const std::string& who) {
  if (place == Place::kWorker) return nullptr;  // bounded by the number of connections
  if (place == Place::kExport) return export_seats_->take(who);
  return (place == Place::kDevice ? device_seats_ : disk_seats_)->take(who);
}

HttpServer::HttpServer(asio::io_context& io, Services& services, Workers& workers,
                       HttpOptions options)
    : io_(io),
      services_(services),
      workers_(workers),
      options_(std::move(options)),
      router_(options_.routes),
      connections_(options_.max_connections, options_.max_connections_per_address,
                   options_.proxies),
      rate_limit_(options_.request_rate),
      bodies_(std::make_shared<BodiesInFlight>(options_.answer_memory)),
      patience_(options_.patience),
      strand_(asio::make_strand(io)),
      acceptor_(strand_),
      pause_(strand_),
      sweeper_(strand_) {}

Expected<std::uint16_t> HttpServer::listen(const Endpoint& endpoint) {
  socket_file_ = endpoint.path;
  return vitrine::listen(acceptor_, endpoint);
}

void HttpServer::set_limits(std::size_t max_connections, std::chrono::seconds patience,
                            std::uint64_t answer_memory) {
  connections_.set_capacity(max_connections);
  bodies_->set_capacity(answer_memory);
  patience_ = patience;
}

void HttpServer::start() {
  const auto failed = [this](std::string_view fault) {
    services_.errors.event(Severity::kError, fault);
  };
  // Out of descriptors, or of memory: connections that end will free some, and the next visitor may
  // have more luck.
  asio::co_spawn(strand_,
                 keep_trying(
                     pause_, std::chrono::milliseconds(100), [this] { return acceptor_.is_open(); },
                     [this] { return accept_one(); }, failed),
                 asio::detached);
  asio::co_spawn(strand_,
                 repeat(
                     sweeper_, std::chrono::seconds(1), [this] { sweep(); }, failed),
                 asio::detached);
}

// False where there was no visitor.
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
  services_.metrics.refused.fetch_add(1, std::memory_order_relaxed);
  if (options_.tls) return;  // a handshake would be work
  answer_at_once(stream, why == ConnectionSet::Admission::kFull
                             ? "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 5\r\n"
                               "Content-Length: 0\r\nConnection: close\r\n\r\n"
                             : "HTTP/1.1 429 Too Many Requests\r\nRetry-After: 5\r\n"
                               "Content-Length: 0\r\nConnection: close\r\n\r\n");
}

asio::awaitable<void> HttpServer::serve(std::shared_ptr<Connection> connection) {
  services_.metrics.connections.fetch_add(1, std::memory_order_relaxed);
  try {
    co_await run_session(connection, *this);
  } catch (const std::exception& fault) {  // out of memory: this connection ends, others go on
    services_.errors.event(Severity::kError, fault.what());
  }
  services_.metrics.connections.fetch_sub(1, std::memory_order_relaxed);
  connections_.remove(*connection);
}

void HttpServer::sweep() {
  connections_.sweep();
  refresh_certificate();
  end_revoked();
}

// Elsewhere, one look at a time: the catalogue may keep it waiting.
void HttpServer::end_revoked() {
  auto callers = connections_.lasting_callers();
  if (callers.empty() || !looking_.expired()) return;
  const auto look = std::make_shared<int>();
  looking_ = look;
  asio::post(workers_.executor(Place::kWorker, ""), [this, look, callers = std::move(callers)] {
    try {
      for (const Caller& caller : callers) {
        const auto in_force = services_.tokens.is_in_force(caller);
        if (in_force && !*in_force) connections_.end_those_of(caller);
      }
    } catch (const std::exception& fault) {
      services_.errors.event(Severity::kError, fault.what());
    }
  });
}

void HttpServer::refresh_certificate() {
  if (!options_.tls) return;
  const auto refreshed = options_.tls->refresh();
  if (!refreshed) {
    services_.errors.event(Severity::kError,
                           "the certificate stays as it was: " + refreshed.error().message);
  } else if (*refreshed) {
    services_.errors.event(Severity::kInfo, "certificate read again");
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

}  // namespace vitrine
