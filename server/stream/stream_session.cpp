// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_session.h"

#include <linux/sockios.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <map>
#include <optional>

#include "server/stream/stream_state.h"
#include "server/transport/least_round_trip.h"
#include "server/transport/no_throw.h"
#include "server/transport/web_socket.h"

namespace vitrine::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Request = WebSocket::Request;
using Opcode = WebSocket::Opcode;
using Model = StreamedModel;

// Largest number of unsent bytes in the kernel's queue. It is small, because a new request cannot
// overtake bytes in that queue.
constexpr int kMostUnsent = 16 * 1024;
constexpr std::size_t kMostAnswers = 16;  // largest number of answers that wait to be sent

StreamState::Time now() {
  return std::chrono::steady_clock::now();
}

// One stream. A reader passes messages to the state, and a writer sends the state's output. Both
// run on the socket's strand.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
 public:
  StreamSession(std::shared_ptr<ByteStream> socket, StreamOptions options, StreamHost& host,
                BusyStreams& busy)
      : socket_(std::move(socket)),
        websocket_(*socket_, {.timeout = options.timeout, .message = kMaxMessage}),
        change_(socket_->get_executor()),
        options_(options),
        host_(host),
        busy_(busy),
        mark_(busy) {}

  asio::awaitable<bool> accept(Request request) {
    const int most = kMostUnsent;
    ::setsockopt(socket_->native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most, sizeof most);
    WebSocket::Headers headers = {{beast::http::field::server, "vitrine"},
                                  {beast::http::field::sec_websocket_protocol, "pmesh.v1"}};
    co_return !co_await websocket_.accept(std::move(request), std::move(headers));
  }

  asio::awaitable<void> run(Model model) {
    host_.on_drain([weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->close_with(websocket::close_code::service_restart);
    });
    open({.model = 0, .id = {}, .wants_head = options_.sends_head}, std::move(model));
    asio::co_spawn(socket_->get_executor(), read(shared_from_this()), asio::detached);
    co_await guarded(&StreamSession::write);
    co_await guarded(&StreamSession::say_goodbye);
    boost::system::error_code ignored;
    socket_->close(ignored);
    while (!has_reader_ended_)
      co_await changed({});
  }

 private:
  // Runs `work`. An exception that it throws ends only this connection.
  asio::awaitable<void> guarded(asio::awaitable<void> (StreamSession::*work)()) {
    try {
      co_await (this->*work)();
    } catch (const std::exception& fault) {
      close_with(websocket::close_code::internal_error);
      host_.failed(fault.what());
    }
  }

  asio::awaitable<void> say_goodbye() {
    if (!goodbye_) co_return;
    host_.waits_for_peer(true);
    co_await websocket_.close(*goodbye_);
  }

  // Wakes run() when the reader ends, for any reason.
  struct ReaderEnd {
    StreamSession& session;
    ~ReaderEnd() {
      session.has_reader_ended_ = true;
      session.change_.cancel();
    }
  };

  static asio::awaitable<void> read(std::shared_ptr<StreamSession> self) {
    const ReaderEnd end{*self};
    co_await self->guarded(&StreamSession::receive_all);
  }

  asio::awaitable<void> receive_all() {
    while (!goodbye_) {
      WebSocket::Message message = co_await websocket_.read();
      if (message.error) break;
      co_await receive(message);
      change_.cancel();
    }
  }

  asio::awaitable<void> receive(const WebSocket::Message& frame) {
    if (frame.opcode != Opcode::kText) {
      close_with({websocket::close_code::policy_error, "a message is a text frame"});
      co_return;
    }
    const auto bytes = frame.span();
    const auto message = parse_message({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    Expected<void> received = {};
    if (!message) {
      received = tl::unexpected(message.error());
    } else if (const auto* wanted = std::get_if<OpenMessage>(&*message)) {
      received = co_await find_and_open(*wanted);
    } else if (const auto* want = std::get_if<WantMessage>(&*message)) {
      received = co_await take_request(*want);
    } else {
      received = act_on(*message);
    }
    if (!received) close_with({websocket::close_code::policy_error, received.error().message});
  }

  asio::awaitable<Expected<void>> find_and_open(const OpenMessage& wanted) {
    auto model = co_await host_.find(wanted.id);
    if (goodbye_) co_return Expected<void>{};
    co_return model ? open(wanted, std::move(*model))
                    : answer(ClosedMessage{wanted.model, model.error().message});
  }

  // Passes a detail request to state_. If the model was hidden or replaced, also closes the
  // connection, so that the client reconnects and gets the current version of the model.
  asio::awaitable<Expected<void>> take_request(const WantMessage& want) {
    const auto model = models_.find(want.model);
    bool is_current = true;
    if (options_.is_direct) {
      if (const auto own = least_round_trip(socket_->native_handle())) state_.know_delay(*own);
    }
    if (model != models_.end()) is_current = co_await host_.is_current(model->second);
    if (!is_current) close_with(websocket::close_code::service_restart);
    co_return state_.receive(want, now());
  }

  Expected<void> act_on(const ClientMessage& message) {
    if (const auto* unwanted = std::get_if<CloseMessage>(&message)) {
      if (models_.erase(unwanted->model) > 0) tell_models();
      if (auto fits = answer(ClosedMessage{unwanted->model, "as asked"}); !fits) return fits;
    }
    return state_.receive(message, now());
  }

  Expected<void> open(const OpenMessage& wanted, Model model) {
    const Manifest& manifest = model->manifest();
    if (auto opened = state_.open(wanted.model, manifest, wanted.wants_head); !opened)
      return opened;
    const ModelMessage message{
        .model = wanted.model,
        .sha256 = to_hex(model->record().file),
        .chunks = manifest.chunks.size(),
        .head_bytes = manifest.head_bytes(),
        .slice_bytes = kMaxSlice,
        .credit = state_.credit(),
        .presentation = client_text(model->record().presentation, model->record().notes)};
    models_[wanted.model] = std::move(model);
    tell_models();
    return answer(message);
  }

  void tell_models() {
    std::vector<Model> models;
    for (const auto& [number, model] : models_)
      models.push_back(model);
    host_.shows(std::move(models));
  }

  Expected<void> answer(const ServerMessage& message) {
    if (answers_.size() >= kMostAnswers)
      return fail(ErrorCode::kBadInput, "read the answers before opening more models");
    answers_.push_back(to_json(message));
    return {};
  }

  // Closes the models' files immediately: a client that does not answer keeps the connection open
  // until the timeout.
  void close_with(websocket::close_reason reason) {
    if (!goodbye_) goodbye_ = std::move(reason);
    state_ = {};
    models_.clear();
    tell_models();
    mark_.set(false);
    change_.cancel();
  }

  // Waits until the reader has received something, the connection is ending, or the time `wakes`
  // has come.
  asio::awaitable<void> changed(std::optional<StreamState::Time> wakes) {
    using Timer = asio::steady_timer;
    change_.expires_at(wakes ? std::chrono::time_point_cast<Timer::duration>(*wakes)
                             : Timer::time_point::max());
    co_await change_.async_wait(kNoThrow);
  }

  asio::awaitable<void> write() {
    bool sent = true;
    while (sent && !goodbye_ && !has_reader_ended_) {
      if (!answers_.empty()) {
        sent = co_await send_text(std::exchange(answers_.front(), {}));
        answers_.erase(answers_.begin());
        continue;
      }
      if (state_.is_granted_ahead()) ask_kernel();
      mark_.set(state_.is_busy());
      const StreamOutput output = state_.next(now(), busy_.count());
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
    const std::array<asio::const_buffer, 1> frame = {asio::buffer(text)};
    host_.waits_for_peer(true);
    const auto error = co_await websocket_.write(Opcode::kText, frame);
    host_.waits_for_peer(false);
    co_return !error;
  }

  asio::awaitable<bool> send_slice(Slice slice) {
    const auto payload = models_[slice.header.model]->read({slice.at, slice.length});
    if (!payload) {
      close_with(websocket::close_code::internal_error);
      co_return true;
    }
    const auto header = to_bytes(slice.header);
    const std::array<asio::const_buffer, 2> frame = {asio::buffer(header), asio::buffer(*payload)};
    host_.waits_for_peer(true);
    const auto error = co_await websocket_.write(Opcode::kBinary, frame);
    host_.waits_for_peer(false);
    if (!error) host_.sent(slice.length);
    co_return !error;
  }

  const std::shared_ptr<ByteStream> socket_;  // kept alive as long as the reader runs
  WebSocket websocket_;
  asio::steady_timer change_;
  StreamOptions options_;
  StreamHost& host_;
  const BusyStreams& busy_;
  BusyMark mark_;
  StreamState state_;
  std::map<std::uint16_t, Model> models_;  // the models that are open in state_
  std::vector<std::string> answers_;       // messages to send before any other output
  std::optional<websocket::close_reason> goodbye_;
  bool has_reader_ended_ = false;
};

}  // namespace

asio::awaitable<void> serve_stream(std::shared_ptr<ByteStream> socket, Request request, Model model,
                                   StreamOptions options, StreamHost& host, BusyStreams& busy) {
  auto session = std::make_shared<StreamSession>(std::move(socket), options, host, busy);
  const bool is_accepted = co_await session->accept(std::exchange(request, {}));
  if (is_accepted) co_await session->run(std::move(model));
}

}  // namespace vitrine::server
