// SPDX-License-Identifier: Apache-2.0
// Serves the protocol pmesh.v1 on one WebSocket connection, from its handshake to its end.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "server/store/published_model.h"
#include "server/stream/busy_streams.h"
#include "server/transport/byte_stream.h"

namespace vitrine::server {

using StreamedModel = std::shared_ptr<const PublishedModel>;

// The interface between a stream and the server. All calls come from the socket's strand.
class StreamHost {
 public:
  virtual ~StreamHost() = default;

  // Finds a model that this client may see. The message of the error is sent to the client.
  virtual boost::asio::awaitable<Expected<StreamedModel>> find(std::string id) = 0;
  // Whether the client may still see the model, and the model's file is still the one that was
  // opened. Called for each detail request. If false, the connection ends with close code 1012.
  virtual boost::asio::awaitable<bool> is_current(StreamedModel model) = 0;
  // Called each time a model is opened or closed. `models` are all models that are now open.
  virtual void shows(std::vector<StreamedModel> models) = 0;
  // Called once, when the stream starts. The host must call `stop` on the socket's strand when the
  // daemon stops; `stop` then closes the connection with close code 1012.
  virtual void on_drain(std::function<void()> stop) = 0;
  // Called with true before a step that the peer must complete within the timeout, and with false
  // after the step.
  virtual void waits_for_peer(bool waits) = 0;
  // Called after each slice is sent, with the length of its payload.
  virtual void sent(std::uint64_t bytes) = 0;
  // Called with the message of an exception that was caught, such as lack of memory. The connection
  // then ends with close code 1011.
  virtual void failed(std::string_view fault) = 0;
};

struct StreamOptions {
  // Time limit for the handshake. Later, a peer that stays silent for this time is pinged, then
  // disconnected.
  std::chrono::seconds timeout{30};
  bool sends_head = false;  // whether to send the model's head first
  bool is_direct = false;   // whether the socket's peer is the client, not a proxy
};

// Serves one connection. Runs on the socket's strand. Returns once no operation on the socket is
// pending. `request` is an upgrade request that offers pmesh.v1. Memory per connection: the
// session's state and one slice. `host` and `busy` must outlive the call.
boost::asio::awaitable<void> serve_stream(
    std::shared_ptr<ByteStream> socket,
    boost::beast::http::request<boost::beast::http::string_body> request, StreamedModel model,
    StreamOptions options, StreamHost& host, BusyStreams& busy);

}  // namespace vitrine::server
