// SPDX-License-Identifier: Apache-2.0
#include "server/transport/byte_stream.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>

#include "server/transport/no_throw.h"
#include "server/transport/tls_context.h"

namespace vitrine::server {

namespace asio = boost::asio;

struct ByteStream::Tls {
  Tls(Socket& socket, std::shared_ptr<asio::ssl::context> shared)
      : context(std::move(shared)), stream(socket, *context) {}

  const std::shared_ptr<asio::ssl::context> context;
  asio::ssl::stream<Socket&> stream;
};

ByteStream::ByteStream(Socket socket) : socket_(std::move(socket)) {
  Error ignored;
  socket_.non_blocking(true, ignored);
}

ByteStream::~ByteStream() = default;

std::string ByteStream::peer_address() const {
  Error error;
  const auto peer = socket_.remote_endpoint(error);
  if (error) return "-";
  const sockaddr* address = peer.data();
  char text[INET6_ADDRSTRLEN] = "-";
  if (address->sa_family == AF_UNIX) return "unix";
  const void* bytes =
      address->sa_family == AF_INET
          ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in*>(address)->sin_addr)
          : &reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
  ::inet_ntop(address->sa_family, bytes, text, sizeof text);
  return text;
}

asio::awaitable<ByteStream::Error> ByteStream::encrypt(std::shared_ptr<const TlsContext> context) {
  asio::ssl::context& native = context->native();
  std::shared_ptr<asio::ssl::context> shared(std::move(context), &native);
  tls_ = std::make_unique<Tls>(socket_, std::move(shared));
  const auto [error] =
      co_await tls_->stream.async_handshake(asio::ssl::stream_base::server, kNoThrow);
  co_return error;
}

asio::awaitable<ByteStream::ClientHandshake> ByteStream::encrypt_to(std::string host) {
  auto context = std::make_shared<asio::ssl::context>(asio::ssl::context::tls_client);
  Error ignored;  // on an error, no certificate is trusted
  context->set_default_verify_paths(ignored);
  context->set_verify_mode(asio::ssl::verify_peer);
  tls_ = std::make_unique<Tls>(socket_, std::move(context));
  SSL* const native = tls_->stream.native_handle();
  asio::ip::make_address(host, ignored);
  // Sends `host` in the server name extension. Omits an IP address, because [RFC6066] section 3
  // forbids addresses in this extension.
  if (ignored) SSL_set_tlsext_host_name(native, host.c_str());
  tls_->stream.set_verify_callback(asio::ssl::host_name_verification(host));
  const auto [error] =
      co_await tls_->stream.async_handshake(asio::ssl::stream_base::client, kNoThrow);
  const long fault = ::SSL_get_verify_result(native);
  const bool is_distrusted =
      error.category() == asio::error::get_ssl_category() && fault != X509_V_OK;
  co_return ClientHandshake{error, is_distrusted ? ::X509_verify_cert_error_string(fault) : ""};
}

asio::awaitable<ByteStream::Error> ByteStream::connect(std::vector<Endpoint> endpoints) {
  const auto [error, endpoint] = co_await asio::async_connect(socket_, endpoints, kNoThrow);
  Error ignored;
  if (!error) socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  co_return error;
}

asio::awaitable<void> ByteStream::finish() {
  if (tls_) co_await tls_->stream.async_shutdown(kNoThrow);
  Error ignored;
  socket_.shutdown(Socket::shutdown_send, ignored);
}

void ByteStream::read_encrypted(Bytes bytes, Done done) {
  tls_->stream.async_read_some(bytes, std::move(done));
}

void ByteStream::write_encrypted(std::vector<std::uint8_t> bytes, Done done) {
  const auto kept = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  tls_->stream.async_write_some(
      asio::buffer(*kept),
      [kept, done = std::move(done)](Error error, std::size_t count) { done(error, count); });
}

}  // namespace vitrine::server
