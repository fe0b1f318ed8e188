// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/stream_client.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <iterator>

#include "server/transport/no_throw.h"
#include "server/transport/web_socket.h"

namespace vitrine::server {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using Opcode = WebSocket::Opcode;
using Clock = std::chrono::steady_clock;

// A connection that stays silent for this long is closed.
constexpr std::chrono::seconds kResponseTimeout{30};
// A fetch gives up if no data arrives for this long, even after new connections.
constexpr std::chrono::seconds kReconnectTimeout{30};
constexpr std::chrono::milliseconds kFirstPause{200}, kLongestPause{3000};
constexpr std::size_t kMaxServerMessage = 64 * 1024;
constexpr unsigned kSwitchingProtocols = 101;

// How a connection ended: the request was met, or the connection was lost.
enum class End { kDone, kLost };

bool is_retried(unsigned status) {
  return status == 502 || status == 503 || status == 504 || status == 429;
}

Error refusal(unsigned status) {
  if (status == 404) return {ErrorCode::kState, "there is no such model (404); check the address"};
  if (status == 401) return {ErrorCode::kState, "the token is unknown (401); check --token"};
  return {ErrorCode::kState,
          fmt::format("the server refuses the stream with status {}; check the address", status)};
}

// Returns the error to report for a failed TLS handshake.
Error no_tls(const ByteStream::ClientHandshake& handshake) {
  if (handshake.distrust.empty()) {
    return {ErrorCode::kState,
            fmt::format("TLS failed: {}; check the address", handshake.error.message())};
  }
  return {ErrorCode::kState,
          fmt::format("its certificate is not trusted: {}; check the address, or name the "
                      "certificate of its authority in SSL_CERT_FILE",
                      handshake.distrust)};
}

class Fetching {
 public:
  Fetching(asio::io_context& io, const FetchOptions& options) : io_(io), options_(options) {}

  asio::awaitable<Expected<Fetched>> run() {
    auto pause = kFirstPause;
    auto progress = Clock::now();
    for (;;) {
      const std::uint64_t before = received_;
      const Expected<End> end = co_await connect();
      if (!end) co_return tl::unexpected(end.error());
      if (*end == End::kDone) break;
      if (received_ > before) pause = kFirstPause, progress = Clock::now();
      if (Clock::now() - progress > kReconnectTimeout) {
        co_return fail(
            ErrorCode::kIo,
            fmt::format(
                "{} cannot be reached: {}; try again to continue, the data received so far is kept",
                options_.url.authority(), lost_));
      }
      asio::steady_timer timer(io_, pause);
      co_await timer.async_wait(kNoThrow);
      pause = std::min<std::chrono::milliseconds>(2 * pause, kLongestPause);
    }
    co_return Fetched{.model = std::move(*model_),
                      .seconds = elapsed(),
                      .received = received_,
                      .promise = promise_,
                      .presentation = presentation_};
  }

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Expected<End> lost(std::string why) {
    lost_ = std::move(why);
    return End::kLost;
  }

  asio::awaitable<Expected<End>> connect() {
    const auto stream = std::make_shared<ByteStream>(ByteStream::Socket(io_));
    const Expected<bool> is_reached = co_await reach(stream);
    if (!is_reached) co_return tl::unexpected(is_reached.error());
    if (!*is_reached) co_return End::kLost;
    WebSocket socket(*stream, {.timeout = kResponseTimeout, .message = kMaxServerMessage});
    const bool has_head = model_ && model_->manifest();
    std::string target = options_.url.target + (has_head ? "" : "?head=true");
    const auto [error, status] =
        co_await socket.request_upgrade(options_.url.authority(), std::move(target), headers());
    if (error) co_return lost(error.message());
    if (is_retried(status)) co_return lost(fmt::format("status {}", status));
    if (status != kSwitchingProtocols) co_return tl::unexpected(refusal(status));
    co_return co_await converse(socket);
  }

  WebSocket::Headers headers() const {
    WebSocket::Headers headers = {{http::field::user_agent, "vitrine"},
                                  {http::field::sec_websocket_protocol, "pmesh.v1"}};
    if (!options_.token.empty())
      headers.emplace_back(http::field::authorization, "Bearer " + options_.token);
    return headers;
  }

  // Connects `stream` to the server. Returns false if the server is unreachable at the moment, and
  // an error if another attempt cannot help.
  asio::awaitable<Expected<bool>> reach(std::shared_ptr<ByteStream> stream) {
    asio::steady_timer deadline(io_, kResponseTimeout);
    deadline.async_wait([weak = std::weak_ptr(stream)](boost::system::error_code cancelled) {
      boost::system::error_code ignored;
      if (const auto late = cancelled ? nullptr : weak.lock()) late->close(ignored);
    });
    asio::ip::tcp::resolver resolver(io_);
    const auto [unknown, found] =
        co_await resolver.async_resolve(options_.url.host, options_.url.port, kNoThrow);
    if (unknown) co_return is_unreachable(unknown);
    std::vector<ByteStream::Endpoint> endpoints;
    for (const auto& entry : found)
      endpoints.emplace_back(entry.endpoint());
    const auto refused = co_await stream->connect(std::move(endpoints));
    if (refused) co_return is_unreachable(refused);
    if (!options_.url.is_encrypted) co_return true;
    const auto handshake = co_await stream->encrypt_to(options_.url.host);
    if (handshake.error.category() == asio::error::get_ssl_category())
      co_return tl::unexpected(no_tls(handshake));
    if (handshake.error) co_return is_unreachable(handshake.error);
    co_return true;
  }

  Expected<bool> is_unreachable(const boost::system::error_code& error) {
    lost_ = error.message();
    return false;
  }

  asio::awaitable<Expected<End>> converse(WebSocket& socket) {
    is_asked_ = is_done_ = false;
    taken_ = 0;
    if (model_) model_->forget_parts();
    while (!is_done_) {
      const WebSocket::Message message = co_await socket.read();
      if (message.error) co_return lost(message.error.message());
      const auto taken =
          message.opcode == Opcode::kText ? take_text(message.span()) : take_slice(message.span());
      if (!taken) co_return tl::unexpected(taken.error());
      const bool told = co_await report_progress(socket);
      if (!told) co_return lost("the server closed the connection");
    }
    const WebSocket::CloseReason done(websocket::close_code::normal);
    co_await socket.close(done);
    co_return End::kDone;
  }

  Expected<void> take_slice(std::span<const std::uint8_t> frame) {
    const auto header = parse_slice(frame);
    if (!header || header->model != 0 || !model_) {
      return fail(ErrorCode::kBadInput, "the server does not support pmesh.v1; ask its operator");
    }
    const auto payload = frame.subspan(kSliceHeader);
    if (auto added = model_->add(*header, payload); !added) return added;
    received_ += payload.size();
    taken_ += payload.size();
    if (options_.on_progress && header->offset + payload.size() == header->total)
      options_.on_progress(*model_);
    return {};
  }

  Expected<void> take_text(std::span<const std::uint8_t> text) {
    const auto message =
        parse_server_message({reinterpret_cast<const char*>(text.data()), text.size()});
    if (!message) return tl::unexpected(message.error());
    if (const auto* opened = std::get_if<ModelMessage>(&*message)) return start(*opened);
    if (const auto* promise = std::get_if<PromiseMessage>(&*message)) promise_ = *promise;
    is_done_ = std::holds_alternative<DoneMessage>(*message) && model_ && model_->manifest();
    return {};
  }

  // Opens the part file of the model. The name of the part file contains the hash of the model's
  // file, so that two versions of a model never mix.
  Expected<void> start(const ModelMessage& opened) {
    if (model_) {
      if (opened.sha256 == sha256_) return {};
      return fail(ErrorCode::kState,
                  "the model has been replaced meanwhile; run the command again");
    }
    if (opened.sha256.size() != 64 ||
        opened.sha256.find_first_not_of("0123456789abcdef") != std::string::npos) {
      return fail(ErrorCode::kBadInput, "the server does not support pmesh.v1; ask its operator");
    }
    sha256_ = opened.sha256;
    presentation_ = from_stored_text(opened.presentation);
    auto path = options_.out;
    path += "." + sha256_.substr(0, 16) + ".part";
    auto model = PartialModel::open(std::move(path));
    if (!model) return tl::unexpected(model.error());
    model_.emplace(std::move(*model));
    return {};
  }

  // Acknowledges the bytes processed. Once per connection, also tells the server which chunks the
  // part file already contains, and sends the detail request.
  asio::awaitable<bool> report_progress(WebSocket& socket) {
    std::vector<ClientMessage> messages;
    if (taken_ > 0) messages.emplace_back(AckMessage{std::exchange(taken_, 0)});
    if (model_ && !std::exchange(is_asked_, true)) {
      std::ranges::copy(have_messages(0, model_->held_ranges()), std::back_inserter(messages));
      messages.emplace_back(WantMessage{.model = 0, .turn = 0, .target = target()});
    }
    for (const ClientMessage& message : messages) {
      const std::string text = to_json(message);
      const std::array<asio::const_buffer, 1> frame = {asio::buffer(text)};
      const auto error = co_await socket.write(Opcode::kText, frame);
      if (error) co_return false;
    }
    co_return true;
  }

  // Returns the detail target to send. If the target is a time in seconds, subtracts the time that
  // has passed.
  DetailTarget target() const {
    if (!options_.target) return Want(WantLevel{UINT32_MAX});
    const auto* timed = std::get_if<WantSeconds>(&*options_.target);
    constexpr double kLeast = 0.001;
    return timed == nullptr ? *options_.target
                            : WantSeconds{std::max(kLeast, timed->seconds - elapsed())};
  }

  asio::io_context& io_;
  const FetchOptions& options_;
  const Clock::time_point start_ = Clock::now();
  std::optional<PartialModel> model_;
  std::string sha256_;
  Presentation presentation_;
  std::optional<PromiseMessage> promise_;
  std::uint64_t received_ = 0;
  std::uint64_t taken_ = 0;  // bytes not acknowledged yet
  bool is_asked_ = false, is_done_ = false;
  std::string lost_;  // why the last connection ended
};

}  // namespace

Expected<Fetched> fetch(const FetchOptions& options) {
  asio::io_context io(1);
  Fetching fetching(io, options);
  Expected<Fetched> result = fail(ErrorCode::kIo, "the connection ended");
  asio::co_spawn(
      io, [&]() -> asio::awaitable<void> { result = co_await fetching.run(); }, asio::detached);
  io.run();
  return result;
}

}  // namespace vitrine::server
