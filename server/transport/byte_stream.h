// SPDX-License-Identifier: Apache-2.0
// The byte stream of one connection: a TCP or Unix socket, with or without TLS. It has the
// interface of a Boost.Asio socket, so that Beast can read from it and use WebSocket over it.
#pragma once

#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace vitrine::server {

class TlsContext;

class ByteStream {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  using Endpoint = boost::asio::generic::stream_protocol::endpoint;
  using executor_type = Socket::executor_type;
  using Error = boost::system::error_code;

  explicit ByteStream(Socket socket);  // makes the socket non-blocking
  ~ByteStream();

  // Performs the server's part of a TLS handshake. After it, all bytes are encrypted.
  boost::asio::awaitable<Error> encrypt(std::shared_ptr<const TlsContext> context);
  struct ClientHandshake {
    Error error;
    // Why the server's certificate is not trusted; empty if `error` has another cause.
    std::string distrust;
  };
  // Performs the client's part of a TLS handshake with `host`. Trusts the certificate authorities
  // of the system, or those in the file that SSL_CERT_FILE names.
  boost::asio::awaitable<ClientHandshake> encrypt_to(std::string host);
  // Connects as a client to the first endpoint that answers.
  boost::asio::awaitable<Error> connect(std::vector<Endpoint> endpoints);
  // Ends the outgoing direction. With TLS, also waits for the peer's close_notify.
  boost::asio::awaitable<void> finish();
  // Whether the stream uses TLS. If it does not, callers may write to native_handle() directly.
  bool is_encrypted() const { return tls_ != nullptr; }

  // Returns the IP address, "unix", or "-" if the peer has disconnected.
  std::string peer_address() const;

  executor_type get_executor() { return socket_.get_executor(); }
  bool is_open() const { return socket_.is_open(); }
  int native_handle() { return socket_.native_handle(); }
  void cancel(Error& error) { socket_.cancel(error); }
  void close(Error& error) { socket_.close(error); }
  template <class Option>
  void set_option(const Option& option, Error& error) {
    socket_.set_option(option, error);
  }
  template <class Token>
  auto async_wait(Socket::wait_type what, Token&& token) {
    return socket_.async_wait(what, std::forward<Token>(token));
  }

 private:
  using Done = std::function<void(Error, std::size_t)>;
  using Bytes = boost::asio::mutable_buffer;

  void read_encrypted(Bytes bytes, Done done);
  void write_encrypted(std::vector<std::uint8_t> bytes, Done done);

  // Makes a copyable function from a handler that can only be moved, because std::function needs a
  // copyable target.
  template <class Handler>
  static Done erase(Handler&& handler) {
    auto shared = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
    return [shared](Error error, std::size_t bytes) { std::move (*shared)(error, bytes); };
  }

  struct Read {
    ByteStream* stream;
    template <class Handler, class Buffers>
    void operator()(Handler&& handler, const Buffers& buffers) const {
      if (!stream->is_encrypted())
        return stream->socket_.async_read_some(buffers, std::forward<Handler>(handler));
      Bytes first;
      for (auto at = boost::asio::buffer_sequence_begin(buffers);
           at != boost::asio::buffer_sequence_end(buffers) && first.size() == 0; ++at) {
        first = *at;
      }
      stream->read_encrypted(first, erase(std::forward<Handler>(handler)));
    }
  };
  struct Write {
    ByteStream* stream;
    template <class Handler, class Buffers>
    void operator()(Handler&& handler, const Buffers& buffers) const {
      if (!stream->is_encrypted())
        return stream->socket_.async_write_some(buffers, std::forward<Handler>(handler));
      constexpr std::size_t kRecord = 16 * 1024;  // size of the largest TLS record
      std::vector<std::uint8_t> bytes(std::min(kRecord, boost::asio::buffer_size(buffers)));
      boost::asio::buffer_copy(boost::asio::buffer(bytes), buffers);
      stream->write_encrypted(std::move(bytes), erase(std::forward<Handler>(handler)));
    }
  };
  using Signature = void(Error, std::size_t);

 public:
  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token)
      -> decltype(boost::asio::async_initiate<Token, Signature>(std::declval<Read>(), token,
                                                                buffers)) {
    return boost::asio::async_initiate<Token, Signature>(Read{this}, token, buffers);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token)
      -> decltype(boost::asio::async_initiate<Token, Signature>(std::declval<Write>(), token,
                                                                buffers)) {
    return boost::asio::async_initiate<Token, Signature>(Write{this}, token, buffers);
  }

  // Beast's WebSocket calls these functions to close the stream.
  friend void beast_close_socket(ByteStream& stream) {
    Error ignored;
    stream.close(ignored);
  }
  friend void teardown(boost::beast::role_type role, ByteStream& stream, Error& error) {
    boost::beast::websocket::teardown(role, stream.socket_, error);
  }
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ByteStream& stream, Handler&& handler) {
    boost::beast::websocket::async_teardown(role, stream.socket_, std::forward<Handler>(handler));
  }

 private:
  struct Tls;

  Socket socket_;
  std::unique_ptr<Tls> tls_;
};

}  // namespace vitrine::server
