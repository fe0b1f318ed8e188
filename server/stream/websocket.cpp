// SPDX-License-Identifier: Apache-2.0
#include "server/stream/websocket.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <optional>

#include "server/stream/stream_state.h"

namespace vitrine {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Request = beast::http::request<beast::http::string_body>;

constexpr auto kNoThrow = asio::as_tuple(asio::use_awaitable);

// A reader that feeds the state and a writer that pulls from it, both on the socket's strand.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(ByteStream& socket, std::shared_ptr<const PublishedModel> model,
                StreamOptions options)
      : websocket_(socket),
        change_(socket.get_executor(), asio::steady_timer::time_point::max()),
        model_(std::move(model)),
        options_(std::move(options)),
        state_(model_->manifest()) {}

  asio::awaitable<void> run(Request request) {
    configure();
    const auto [error] = co_await websocket_.async_accept(request, kNoThrow);
    if (error) co_return;
    options_.on_drain([weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->close_with(websocket::close_code::service_restart);
    });
    asio::co_spawn(websocket_.get_executor(), read(shared_from_this()), asio::detached);
    const bool greeted = co_await greet();
    if (greeted) co_await write();
    if (goodbye_) co_await websocket_.async_close(*goodbye_, kNoThrow);
    boost::system::error_code ignored;
    websocket_.next_layer().close(ignored);
    while (!reader_ended_)
      co_await changed();
  }

 private:
  void configure() {
    websocket::stream_base::timeout timeout;
    timeout.handshake_timeout = options_.patience;
    timeout.idle_timeout = options_.patience;
    timeout.keep_alive_pings = true;
    websocket_.set_option(timeout);
    websocket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(beast::http::field::server, "vitrine");
      response.set(beast::http::field::sec_websocket_protocol, "pmesh.v1");
    }));
    websocket_.read_message_max(kMaxMessage);
    websocket_.auto_fragment(false);
  }

  static asio::awaitable<void> read(std::shared_ptr<StreamSession> self) {
    beast::flat_buffer buffer;
    while (!self->goodbye_) {
      const auto [error, bytes] = co_await self->websocket_.async_read(buffer, kNoThrow);
      if (error) break;
      self->receive(buffer);
      buffer = beast::flat_buffer();  // an idle connection holds none
      self->change_.cancel();
    }
    self->reader_ended_ = true;
    self->change_.cancel();
  }

  void receive(const beast::flat_buffer& buffer) {
    if (!websocket_.got_text()) {
      return close_with({websocket::close_code::policy_error, "a message is a text frame"});
    }
    const auto data = buffer.cdata();
    const auto message = parse_message({static_cast<const char*>(data.data()), data.size()});
    const auto received = message ? state_.receive(*message) : Unexpected(message.error());
    if (!received) close_with({websocket::close_code::policy_error, received.error().message});
  }

  void close_with(websocket::close_reason reason) {
    if (!goodbye_) goodbye_ = std::move(reason);
    change_.cancel();
  }

  // Until the reader has received something or the end is near.
  asio::awaitable<void> changed() {
    change_.expires_at(asio::steady_timer::time_point::max());
    co_await change_.async_wait(kNoThrow);
  }

  asio::awaitable<bool> greet() {
    const ModelMessage message{.sha256 = to_hex(model_->record().file),
                               .chunks = model_->manifest().chunks.size(),
                               .slice_bytes = kMaxSlice,
                               .credit = state_.credit()};
    co_return co_await send_text(to_json(message));
  }

  asio::awaitable<void> write() {
    bool sent = true;
    while (sent && !goodbye_ && !reader_ended_) {
      const StreamState::Output output = state_.next();
      if (const auto* slice = std::get_if<Slice>(&output)) {
        sent = co_await send_slice(*slice);
      } else if (const auto* done = std::get_if<DoneMessage>(&output)) {
        sent = co_await send_text(to_json(*done));
      } else {
        co_await changed();
      }
    }
  }

  asio::awaitable<bool> send_text(std::string text) {
    websocket_.text(true);
    const auto [error, bytes] = co_await websocket_.async_write(asio::buffer(text), kNoThrow);
    co_return !error;
  }

  asio::awaitable<bool> send_slice(Slice slice) {
    if (!load(slice)) co_return false;
    const ChunkInfo& chunk = model_->manifest().chunks[slice.chunk];
    const SliceHeader header = slice_header(chunk, slice);
    const std::array<asio::const_buffer, 2> frame = {
        asio::buffer(header), asio::buffer(bytes_.data() + slice.offset, slice.length)};
    websocket_.binary(true);
    const auto [error, bytes] = co_await websocket_.async_write(frame, kNoThrow);
    if (slice.offset + slice.length == chunk.length) bytes_ = {};
    if (!error) options_.sent(slice.length);
    co_return !error;
  }

  // Reads the slice's chunk into bytes_ where it starts.
  bool load(const Slice& slice) {
    if (slice.offset > 0) return true;
    auto bytes = model_->read(model_->chunk(slice.chunk));
    if (bytes) {
      bytes_ = std::move(*bytes);
    } else {
      close_with(websocket::close_code::internal_error);
    }
    return bytes.has_value();
  }

  websocket::stream<ByteStream&, /*deflate=*/false> websocket_;
  asio::steady_timer change_;
  std::shared_ptr<const PublishedModel> model_;
  StreamOptions options_;
  StreamState state_;
  std::vector<std::uint8_t> bytes_;  // of the chunk being sent
  std::optional<websocket::close_reason> goodbye_;
  bool reader_ended_ = false;
};

}  // namespace

asio::awaitable<void> serve_stream(ByteStream& socket, Request request,
                                   std::shared_ptr<const PublishedModel> model,
                                   StreamOptions options) {
  auto session = std::make_shared<StreamSession>(socket, std::move(model), std::move(options));
  co_await session->run(std::move(request));
}

}  // namespace vitrine
