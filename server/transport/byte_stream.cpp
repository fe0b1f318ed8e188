// SPDX-License-Identifier: Apache-2.0
#include "server/transport/byte_stream.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "server/transport/tls_context.h"

namespace vitrine {

namespace asio = boost::asio;

namespace {
constexpr auto kNoThrow = asio::as_tuple(asio::use_awaitable);
}  // namespace

struct ByteStream::Tls {
  Tls(Socket& socket, std::shared_ptr<const TlsContext> owner)
      : context(std::move(owner)), stream(socket, context->native()) {}

  const std::shared_ptr<const TlsContext> context;
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
  tls_ = std::make_unique<Tls>(socket_, std::move(context));
  const auto [error] =
      co_await tls_->stream.async_handshake(asio::ssl::stream_base::server, kNoThrow);
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

}  // namespace vitrine
