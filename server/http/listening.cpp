// SPDX-License-Identifier: Apache-2.0
#include "server/http/listening.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/stat.h>

#include <boost/asio/local/stream_protocol.hpp>
#include <filesystem>

namespace vitrine::server {
namespace {

using Unix = asio::local::stream_protocol;
using boost::system::error_code;

Unexpected cannot_listen(const Endpoint& endpoint, const error_code& error) {
  const bool taken = error == asio::error::address_in_use;
  if (!endpoint.path.empty()) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot listen on unix:{}: {}; {}", endpoint.path, error.message(),
                            taken ? "stop the program that listens there, or move the file"
                                  : "check that its folder exists and may be written"));
  }
  return fail(ErrorCode::kIo, fmt::format("cannot listen on {}:{}: {}; {}", endpoint.host,
                                          endpoint.port, error.message(),
                                          taken ? "stop the other program or choose another port"
                                                : "choose another address"));
}

// Whether `endpoint.path` is a socket file on which no process listens any more.
bool is_left_over(const Endpoint& endpoint) {
  std::error_code ignored;
  if (!std::filesystem::is_socket(endpoint.path, ignored)) return false;
  asio::io_context io;
  error_code error;
  Unix::socket(io).connect(Unix::endpoint(endpoint.path), error);
  return error == asio::error::connection_refused;
}

Expected<void> bind(Acceptor& acceptor, const Endpoint& endpoint) {
  error_code error;
  if (!endpoint.path.empty()) {
    if (is_left_over(endpoint)) std::filesystem::remove(endpoint.path);
    const Unix::endpoint local(endpoint.path);
    acceptor.open(Unix(), error);
    if (!error) acceptor.bind(local, error);
  } else {
    const auto address = asio::ip::make_address(endpoint.host, error);
    if (error) return cannot_listen(endpoint, error);
    const Tcp::endpoint local(address, endpoint.port);
    acceptor.open(local.protocol(), error);
    if (!error) acceptor.set_option(Acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(local, error);
  }
  if (error) return cannot_listen(endpoint, error);
  return {};
}

std::uint16_t port_of(const asio::generic::stream_protocol::endpoint& local) {
  const sockaddr* address = local.data();
  if (address->sa_family == AF_INET)
    return ntohs(reinterpret_cast<const sockaddr_in*>(address)->sin_port);
  if (address->sa_family == AF_INET6)
    return ntohs(reinterpret_cast<const sockaddr_in6*>(address)->sin6_port);
  return 0;
}

}  // namespace

Expected<void> check_address(const Endpoint& endpoint) {
  asio::io_context io;
  Acceptor acceptor(io);
  auto bound = bind(acceptor, endpoint);
  std::error_code ignored;
  if (bound && !endpoint.path.empty()) std::filesystem::remove(endpoint.path, ignored);
  return bound;
}

Expected<std::uint16_t> listen(Acceptor& acceptor, const Endpoint& endpoint) {
  if (auto bound = bind(acceptor, endpoint); !bound) return tl::unexpected(bound.error());
  error_code error;
  if (!endpoint.path.empty()) ::chmod(endpoint.path.c_str(), 0660);
  acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return cannot_listen(endpoint, error);
  return port_of(acceptor.local_endpoint());
}

}  // namespace vitrine::server
