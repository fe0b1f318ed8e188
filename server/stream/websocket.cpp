// SPDX-License-Identifier: Apache-2.0
#include "server/stream/websocket.h"

#include <linux/sockios.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <map>
#include <optional>

#include "server/stream/stream_state.h"
#include "server/transport/least_round_trip.h"

namespace vitrine {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Request = beast::http::request<beast::http::string_body>;
using Model = StreamedModel;

constexpr auto kNoThrow = asio::as_tuple(asio::use_awaitable);
constexpr int kMostUnsent = 16 * 1024;  // in the kernel's queue, so that new wishes overtake little
constexpr std::size_t kMostAnswers = 16;  // that wait for the peer to take them

StreamState::Time now() {
  return std::chrono::steady_clock::now();
}

// A reader that feeds the state and a writer that pulls from it, both on the socket's strand.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(std::shared_ptr<ByteStream> socket, StreamOptions options, Crowd& crowd)
      : socket_(std::move(socket)),
        websocket_(*socket_),
        change_(socket_->get_executor()),
        options_(std::move(options)),
        crowd_(crowd),
        member_(crowd) {}

  asio::awaitable<bool> accept(Request request) {
    configure();
    const auto [error] = co_await websocket_.async_accept(request, kNoThrow);
    co_return !error;
  }

  asio::awaitable<void> run(Model model) {
    options_.on_drain([weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->close_with(websocket::close_code::service_restart);
    });
    open({.model = 0, .id = {}, .head = options_.head}, std::move(model));
    asio::co_spawn(websocket_.get_executor(), read(shared_from_this()), asio::detached);
    co_await guarded(&StreamSession::write);
    co_await guarded(&StreamSession::say_goodbye);
    boost::system::error_code ignored;
    socket_->close(ignored);
    while (!reader_ended_)
      co_await changed({});
  }

 private:
  // What is thrown there ends this connection, and no other.
  asio::awaitable<void> guarded(asio::awaitable<void> (StreamSession::*work)()) {
    try {
      co_await (this->*work)();
    } catch (const std::exception& fault) {
      close_with(websocket::close_code::internal_error);
      options_.failed(fault.what());
    }
  }

  asio::awaitable<void> say_goodbye() {
    if (!goodbye_) co_return;
    options_.waits_for_peer(true);
    co_await websocket_.async_close(*goodbye_, kNoThrow);
  }

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
    const int most = kMostUnsent;
    ::setsockopt(socket_->native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most, sizeof most);
  }

  // However the reader ends, run() is told.
  struct ReaderEnd {
    StreamSession& session;
    ~ReaderEnd() {
      session.reader_ended_ = true;
      session.change_.cancel();
    }
  };

  static asio::awaitable<void> read(std::shared_ptr<StreamSession> self) {
    const ReaderEnd end{*self};
    co_await self->guarded(&StreamSession::receive_all);
  }

  asio::awaitable<void> receive_all() {
    beast::flat_buffer buffer;
    while (!goodbye_) {
      const auto [error, bytes] = co_await websocket_.async_read(buffer, kNoThrow);
      if (error) break;
      co_await receive(buffer);
      buffer = beast::flat_buffer();  // an idle connection holds none
      change_.cancel();
    }
  }

  asio::awaitable<void> receive(const beast::flat_buffer& buffer) {
    if (!websocket_.got_text()) {
      close_with({websocket::close_code::policy_error, "a message is a text frame"});
      co_return;
    }
    const auto data = buffer.cdata();
    const auto message = parse_message({static_cast<const char*>(data.data()), data.size()});
    Expected<void> received = {};
    if (!message) {
      received = Unexpected(message.error());
    } else if (const auto* wanted = std::get_if<OpenMessage>(&*message)) {
      received = co_await find_and_open(*wanted);
    } else if (const auto* wish = std::get_if<WantMessage>(&*message)) {
      received = co_await take_wish(*wish);
    } else {
      received = act_on(*message);
    }
    if (!received) close_with({websocket::close_code::policy_error, received.error().message});
  }

  asio::awaitable<Expected<void>> find_and_open(const OpenMessage& wanted) {
    auto model = co_await options_.find(wanted.id);
    co_return model ? open(wanted, std::move(*model))
                    : answer(ClosedMessage{wanted.model, model.error().message});
  }

  // Of a model that was hidden or replaced the next connection tells what there is now.
  asio::awaitable<Expected<void>> take_wish(const WantMessage& wish) {
    const auto model = models_.find(wish.model);
    bool is_current = true;
    if (options_.is_direct) {
      if (const auto own = least_round_trip(socket_->native_handle())) state_.know_delay(*own);
    }
    if (model != models_.end()) is_current = co_await options_.is_current(model->second);
    if (!is_current) close_with(websocket::close_code::service_restart);
    co_return state_.receive(wish, now());
  }

  Expected<void> act_on(const ClientMessage& message) {
    if (const auto* unwanted = std::get_if<CloseMessage>(&message)) {
      models_.erase(unwanted->model);
      if (auto fits = answer(ClosedMessage{unwanted->model, "as asked"}); !fits) return fits;
    }
    return state_.receive(message, now());
  }

  Expected<void> open(const OpenMessage& wanted, Model model) {
    const Manifest& manifest = model->manifest();
    if (auto opened = state_.open(wanted.model, manifest, wanted.head); !opened) return opened;
    const ModelMessage message{.model = wanted.model,
                               .sha256 = to_hex(model->record().file),
                               .chunks = manifest.chunks.size(),
                               .head_bytes = manifest.head_bytes(),
                               .slice_bytes = kMaxSlice,
                               .credit = state_.credit()};
    models_[wanted.model] = std::move(model);
    return answer(message);
  }

  Expected<void> answer(const ServerMessage& message) {
    if (answers_.size() >= kMostAnswers)
      return fail(ErrorCode::kBadInput, "read the answers before opening more models");
    answers_.push_back(to_json(message));
    return {};
  }

  void close_with(websocket::close_reason reason) {
    if (!goodbye_) goodbye_ = std::move(reason);
    change_.cancel();
  }

  // Until the reader has received something, the end is near, or it is time.
  asio::awaitable<void> changed(std::optional<StreamState::Time> wakes) {
    using Timer = asio::steady_timer;
    change_.expires_at(wakes ? std::chrono::time_point_cast<Timer::duration>(*wakes)
                             : Timer::time_point::max());
    co_await change_.async_wait(kNoThrow);
  }

  asio::awaitable<void> write() {
    bool sent = true;
    while (sent && !goodbye_ && !reader_ended_) {
      if (!answers_.empty()) {
        sent = co_await send_text(std::exchange(answers_.front(), {}));
        answers_.erase(answers_.begin());
        continue;
      }
      if (state_.is_granted_ahead()) ask_kernel();
      member_.set_busy(state_.is_busy());
      const StreamOutput output = state_.next(now(), crowd_.busy());
      if (const auto* slice = std::get_if<Slice>(&output)) {
        sent = co_await send_slice(*slice);
      } else if (const auto* promise = std::get_if<PromiseMessage>(&output)) {
        sent = co_await send_text(to_json(*promise));
      } else if (const auto* done = std::get_if<DoneMessage>(&output)) {
        sent = co_await send_text(to_json(*done));
      } else {
        co_await changed(state_.wakes(now()));
      }
    }
  }

  void ask_kernel() {
    int queued = 0;
    if (::ioctl(socket_->native_handle(), SIOCOUTQ, &queued) == 0 && queued >= 0)
      state_.still_queued(static_cast<std::uint64_t>(queued), now());
  }

  asio::awaitable<bool> send_text(std::string text) {
    websocket_.text(true);
    options_.waits_for_peer(true);
    const auto [error, bytes] = co_await websocket_.async_write(asio::buffer(text), kNoThrow);
    options_.waits_for_peer(false);
    co_return !error;
  }

  asio::awaitable<bool> send_slice(Slice slice) {
    const Model model = models_[slice.header.model];
    const auto payload = model->read({slice.at, slice.length});
    if (!payload) {
      close_with(websocket::close_code::internal_error);
      co_return true;
    }
    const auto header = to_bytes(slice.header);
    const std::array<asio::const_buffer, 2> frame = {asio::buffer(header), asio::buffer(*payload)};
    websocket_.binary(true);
    options_.waits_for_peer(true);
    const auto [error, bytes] = co_await websocket_.async_write(frame, kNoThrow);
    options_.waits_for_peer(false);
    if (!error) options_.sent(slice.length);
    co_return !error;
  }

  const std::shared_ptr<ByteStream> socket_;  // as long as the reader lives
  websocket::stream<ByteStream&, /*deflate=*/false> websocket_;
  asio::steady_timer change_;
  StreamOptions options_;
  const Crowd& crowd_;
  CrowdMember member_;
  StreamState state_;
  std::map<std::uint16_t, Model> models_;  // that state_ knows
  std::vector<std::string> answers_;       // to be sent first
  std::optional<websocket::close_reason> goodbye_;
  bool reader_ended_ = false;
};

}  // namespace

asio::awaitable<void> serve_stream(std::shared_ptr<ByteStream> socket, Request request, Model model,
                                   StreamOptions options, Crowd& crowd) {
  auto session = std::make_shared<StreamSession>(std::move(socket), std::move(options), crowd);
  const bool accepted = co_await session->accept(std::exchange(request, {}));
  if (accepted) co_await session->run(std::move(model));
}

}  // namespace vitrine
