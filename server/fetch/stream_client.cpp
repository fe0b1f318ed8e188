// SPDX-License-Identifier: Apache-2.0
#include "server/fetch/stream_client.h"

#include <fmt/core.h>

#include <algorithm>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <iterator>

namespace vitrine {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;

constexpr auto kNoThrow = asio::as_tuple(asio::use_awaitable);
constexpr std::chrono::seconds kSilence{30};   // a connection that brings nothing is given up
constexpr std::chrono::seconds kPatience{30};  // with servers that are not there
constexpr std::chrono::milliseconds kFirstPause{200}, kLongestPause{3000};
constexpr std::size_t kMaxServerMessage = 64 * 1024;

// How one connection has ended.
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

// Why TLS has failed.
Error no_tls(SSL* tls, const boost::system::error_code& error) {
  const long fault = ::SSL_get_verify_result(tls);
  if (fault == X509_V_OK)
    return {ErrorCode::kState, fmt::format("no TLS: {}; check the address", error.message())};
  return {ErrorCode::kState,
          fmt::format("its certificate is not trusted: {}; check the address, or name the "
                      "certificate of its authority in SSL_CERT_FILE",
                      ::X509_verify_cert_error_string(fault))};
}

class Fetching {
 public:
  Fetching(asio::io_context& io, const FetchOptions& options) : io_(io), options_(options) {
    boost::system::error_code ignored;  // then no certificate is trusted
    tls_.set_default_verify_paths(ignored);
    tls_.set_verify_mode(asio::ssl::verify_peer);
  }

  asio::awaitable<Expected<Fetched>> run() {
    auto pause = kFirstPause;
    auto progress = Clock::now();
    for (;;) {
      const std::uint64_t before = received_;
      const Expected<End> end = co_await connect();
      if (!end) co_return tl::unexpected(end.error());
      if (*end == End::kDone) break;
      if (received_ > before) pause = kFirstPause, progress = Clock::now();
      if (Clock::now() - progress > kPatience) {
        co_return fail(ErrorCode::kIo,
                       fmt::format("{} cannot be reached: {}; try again, what has come is kept",
                                   options_.url.authority(), lost_));
      }
      asio::steady_timer timer(io_, pause);
      co_await timer.async_wait(kNoThrow);
      pause = std::min<std::chrono::milliseconds>(2 * pause, kLongestPause);
    }
    co_return Fetched{std::move(*model_), elapsed(), received_, promise_};
  }

 private:
  using Tcp = beast::tcp_stream;
  using Tls = beast::ssl_stream<Tcp>;
  template <class Stream>
  using Socket = websocket::stream<Stream, /*deflate=*/false>;

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Expected<End> lost(std::string why) {
    lost_ = std::move(why);
    return End::kLost;
  }

  asio::awaitable<Expected<End>> connect() {
    if (options_.url.is_encrypted) {
      Socket<Tls> socket(io_, tls_);
      co_return co_await connect(socket);
    }
    Socket<Tcp> socket(io_);
    co_return co_await connect(socket);
  }

  template <class Stream>
  asio::awaitable<Expected<End>> connect(Socket<Stream>& socket) {
    beast::get_lowest_layer(socket).expires_after(kSilence);
    const Expected<bool> reached = co_await reach(socket.next_layer());
    if (!reached) co_return tl::unexpected(reached.error());
    if (!*reached) co_return End::kLost;
    beast::get_lowest_layer(socket).expires_never();
    configure(socket);
    http::response<http::string_body> answer;
    const bool has_head = model_ && model_->manifest();
    const std::string target = options_.url.target + (has_head ? "" : "?head=true");
    const auto [failed] =
        co_await socket.async_handshake(answer, options_.url.authority(), target, kNoThrow);
    const unsigned status = answer.result_int();
    if (failed && failed != websocket::error::upgrade_declined) co_return lost(failed.message());
    if (failed && is_retried(status)) co_return lost(fmt::format("status {}", status));
    if (failed) co_return tl::unexpected(refusal(status));
    co_return co_await converse(socket);
  }

  // False where the server is not there now; an error where it never will be.
  asio::awaitable<Expected<bool>> reach(Tcp& stream) {
    asio::ip::tcp::resolver resolver(io_);
    const auto [unknown, addresses] =
        co_await resolver.async_resolve(options_.url.host, options_.url.port, kNoThrow);
    if (unknown) lost_ = unknown.message();
    if (unknown) co_return false;
    const auto [refused, endpoint] = co_await stream.async_connect(addresses, kNoThrow);
    if (refused) lost_ = refused.message();
    if (refused) co_return false;
    boost::system::error_code ignored;
    stream.socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    co_return true;
  }

  asio::awaitable<Expected<bool>> reach(Tls& stream) {
    const Expected<bool> reached = co_await reach(stream.next_layer());
    if (!reached || !*reached) co_return reached;
    const std::string& host = options_.url.host;
    boost::system::error_code none;
    if (asio::ip::make_address(host, none); none)  // RFC 6066, 3: names alone
      SSL_set_tlsext_host_name(stream.native_handle(), host.c_str());
    stream.set_verify_callback(asio::ssl::host_name_verification(host));
    const auto [failed] = co_await stream.async_handshake(asio::ssl::stream_base::client, kNoThrow);
    if (failed.category() == asio::error::get_ssl_category())
      co_return tl::unexpected(no_tls(stream.native_handle(), failed));
    if (failed) lost_ = failed.message();
    co_return !failed;
  }

  template <class Stream>
  void configure(Socket<Stream>& socket) {
    websocket::stream_base::timeout timeout;
    timeout.handshake_timeout = kSilence;
    timeout.idle_timeout = kSilence;
    timeout.keep_alive_pings = true;
    socket.set_option(timeout);
    socket.read_message_max(kMaxServerMessage);
    socket.set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
      request.set(http::field::user_agent, "vitrine");
      request.set(http::field::sec_websocket_protocol, "pmesh.v1");
      if (!options_.token.empty())
        request.set(http::field::authorization, "Bearer " + options_.token);
    }));
  }

  template <class Stream>
  asio::awaitable<Expected<End>> converse(Socket<Stream>& socket) {
    is_asked_ = is_done_ = false;
    beast::flat_buffer buffer;
    while (!is_done_) {
      const auto [error, bytes] = co_await socket.async_read(buffer, kNoThrow);
      if (error) {
        if (model_) model_->forget_parts();
        co_return lost(error.message());
      }
      const auto data = buffer.cdata();
      const std::span<const std::uint8_t> message(static_cast<const std::uint8_t*>(data.data()),
                                                  data.size());
      const auto taken = socket.got_text() ? take_text(message) : take_slice(message);
      buffer.consume(buffer.size());
      if (!taken) co_return tl::unexpected(taken.error());
      const bool told = co_await tell(socket);
      if (!told) co_return lost("it no longer listens");
    }
    co_await socket.async_close(websocket::close_code::normal, kNoThrow);
    co_return End::kDone;
  }

  Expected<void> take_slice(std::span<const std::uint8_t> frame) {
    const auto header = parse_slice(frame);
    if (!header || header->model != 0 || !model_) {
      return fail(ErrorCode::kBadInput, "the server does not speak pmesh.v1; ask its operator");
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

  // The part file's name has the hash of the model's file, so that it never mixes two.
  Expected<void> start(const ModelMessage& opened) {
    if (model_) {
      if (opened.sha256 == sha256_) return {};
      return fail(ErrorCode::kState,
                  "the model has been replaced meanwhile; run the command again");
    }
    if (opened.sha256.size() != 64 ||
        opened.sha256.find_first_not_of("0123456789abcdef") != std::string::npos) {
      return fail(ErrorCode::kBadInput, "the server does not speak pmesh.v1; ask its operator");
    }
    sha256_ = opened.sha256;
    auto path = options_.out;
    path += "." + sha256_.substr(0, 16) + ".part";
    auto model = PartialModel::open(std::move(path));
    if (!model) return tl::unexpected(model.error());
    model_.emplace(std::move(*model));
    return {};
  }

  // Acknowledges what was taken, and asks once it is known what is there already.
  template <class Stream>
  asio::awaitable<bool> tell(Socket<Stream>& socket) {
    std::vector<ClientMessage> messages;
    if (taken_ > 0) messages.emplace_back(AckMessage{std::exchange(taken_, 0)});
    if (model_ && !std::exchange(is_asked_, true)) {
      std::ranges::copy(have_messages(0, model_->held_ranges()), std::back_inserter(messages));
      messages.emplace_back(WantMessage{.model = 0, .turn = 0, .wish = wish()});
    }
    for (const ClientMessage& message : messages) {
      socket.text(true);
      const std::string text = to_json(message);
      const auto [error, bytes] = co_await socket.async_write(asio::buffer(text), kNoThrow);
      if (error) co_return false;
    }
    co_return true;
  }

  // Of a time the connections so far have taken their share.
  Wish wish() const {
    if (!options_.wish) return Want(WantLevel{UINT32_MAX});
    const auto* timed = std::get_if<WantSeconds>(&*options_.wish);
    constexpr double kLeast = 0.001;
    return timed == nullptr ? *options_.wish
                            : WantSeconds{std::max(kLeast, timed->seconds - elapsed())};
  }

  asio::io_context& io_;
  const FetchOptions& options_;
  asio::ssl::context tls_{asio::ssl::context::tls_client};
  const Clock::time_point start_ = Clock::now();
  std::optional<PartialModel> model_;
  std::string sha256_;
  std::optional<PromiseMessage> promise_;
  std::uint64_t received_ = 0;
  std::uint64_t taken_ = 0;  // and not acknowledged yet
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

}  // namespace vitrine
