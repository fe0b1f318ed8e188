// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include <fmt/format.h>

#include "server/http/services.h"
#include "server/http/session.h"

namespace vitrine {
namespace {

constexpr std::size_t kLanes = 16;

Unexpected cannot_listen(const Endpoint& endpoint, const boost::system::error_code& error) {
  const bool taken = error == asio::error::address_in_use;
  return fail(ErrorCode::kIo, fmt::format("cannot listen on {}:{}: {}; {}", endpoint.host,
                                          endpoint.port, error.message(),
                                          taken ? "stop the other program or choose another port"
                                                : "choose another address"));
}

Expected<void> bind(Tcp::acceptor& acceptor, const Endpoint& endpoint) {
  boost::system::error_code error;
  const auto address = asio::ip::make_address(endpoint.host, error);
  if (error) return cannot_listen(endpoint, error);
  const Tcp::endpoint local(address, endpoint.port);
  acceptor.open(local.protocol(), error);
  if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(local, error);
  if (error) return cannot_listen(endpoint, error);
  return {};
}

}  // namespace

Expected<void> check_address(const Endpoint& endpoint) {
  asio::io_context io;
  Tcp::acceptor acceptor(io);
  return bind(acceptor, endpoint);
}

Workers::Workers(unsigned threads, std::size_t max_exports)
    : pool_(threads), exports_(threads), export_seats_(std::make_shared<Seats>(max_exports)) {
  for (std::size_t i = 0; i < kLanes; ++i)
    lanes_.push_back(asio::make_strand(exports_.executor()));
}

asio::any_io_executor Workers::executor(Place place, std::string_view target) {
  if (place == Place::kDevice) return devices_.executor();
  if (place != Place::kExport) return pool_.executor();
  return lanes_[std::hash<std::string_view>{}(target) % kLanes];
}

std::shared_ptr<const void> Workers::reserve(Place place) {
  if (place == Place::kWorker) return export_seats_;  // bounded by the number of connections
  const auto& seats = place == Place::kExport ? export_seats_ : device_seats_;
  if (seats->taken.fetch_add(1) >= seats->capacity) {
    seats->taken.fetch_sub(1);
    return nullptr;
  }
  return {seats.get(), [seats](const void*) { seats->taken.fetch_sub(1); }};
}

HttpServer::HttpServer(asio::io_context& io, Services& services, Workers& workers,
                       HttpOptions options)
    : io_(io),
      services_(services),
      workers_(workers),
      options_(std::move(options)),
      router_(options_.routes),
      connections_(options_.max_connections),
      strand_(asio::make_strand(io)),
      acceptor_(strand_),
      sweeper_(strand_) {}

Expected<std::uint16_t> HttpServer::listen(const Endpoint& endpoint) {
  if (auto bound = bind(acceptor_, endpoint); !bound) return Unexpected(bound.error());
  boost::system::error_code error;
  acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) return cannot_listen(endpoint, error);
  return acceptor_.local_endpoint().port();
}

void HttpServer::start() {
  asio::co_spawn(strand_, accept(), asio::detached);
  asio::co_spawn(strand_, sweep(), asio::detached);
}

asio::awaitable<void> HttpServer::accept() {
  while (acceptor_.is_open()) {
    auto [error, socket] = co_await acceptor_.async_accept(asio::make_strand(io_), kNoThrow);
    if (error == asio::error::operation_aborted) co_return;
    if (error) {  // out of descriptors, most likely: the connections that end will free some
      asio::steady_timer pause(strand_, std::chrono::milliseconds(100));
      co_await pause.async_wait(kNoThrow);
      continue;
    }
    try {
      admit(std::move(socket));
    } catch (const std::exception& fault) {  // out of memory: the next visitor may have more luck
      services_.errors.event(Severity::kError, fault.what());
    }
  }
}

void HttpServer::admit(Tcp::socket socket) {
  auto connection = std::make_shared<Connection>(std::move(socket));
  if (!connections_.add(connection)) {
    services_.metrics.refused.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  const auto executor = connection->socket.get_executor();
  asio::co_spawn(executor, serve(std::move(connection)), asio::detached);
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

asio::awaitable<void> HttpServer::sweep() {
  for (;;) {
    sweeper_.expires_after(std::chrono::seconds(1));
    const auto [error] = co_await sweeper_.async_wait(kNoThrow);
    if (error) co_return;
    connections_.sweep();
  }
}

void HttpServer::drain(std::function<void()> on_empty) {
  asio::post(strand_, [this, on_empty = std::move(on_empty)]() mutable {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    connections_.drain(std::move(on_empty));
  });
}

}  // namespace vitrine
