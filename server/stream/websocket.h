// SPDX-License-Identifier: Apache-2.0
// The I/O of pmesh.v1: one WebSocket from its handshake to its end.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string_view>

#include "server/store/published_model.h"
#include "server/stream/crowd.h"
#include "server/transport/byte_stream.h"

namespace vitrine {

using StreamedModel = std::shared_ptr<const PublishedModel>;

struct StreamOptions {
  std::chrono::seconds patience{30};  // for handshakes, and before a silent peer is pinged and cut
  bool head = false;                  // the model's head comes first
  bool is_direct = false;             // the peer of the socket is the client: no proxy
  // A model that this client may see; fails with what the client is told. Off the socket's strand.
  std::function<boost::asio::awaitable<Expected<StreamedModel>>(std::string id)> find;
  // Whether this client may still see the model, and its file is the one that was opened. Asked at
  // each `want`: where it is not, the connection ends (close 1012). Off the socket's strand.
  std::function<boost::asio::awaitable<bool>(StreamedModel model)> is_current;
  // Called once with what to call on the socket's strand when the daemon stops (close 1012).
  std::function<void(std::function<void()> stop)> on_drain;
  std::function<void(std::uint64_t bytes)> sent;  // called with the chunk bytes of each slice
  // Called before (true) and after what the peer has to take within the patience.
  std::function<void(bool waits)> waits_for_peer;
  // Called with what was thrown (memory has run out): this connection ends with 1011.
  std::function<void(std::string_view fault)> failed;
};

// Runs on the socket's strand, and returns when nothing is pending there. `request` is an upgrade
// that offers pmesh.v1. Memory per connection: the session's state, and the one slice that is being
// sent. The crowd outlives it.
boost::asio::awaitable<void> serve_stream(
    std::shared_ptr<ByteStream> socket,
    boost::beast::http::request<boost::beast::http::string_body> request, StreamedModel model,
    StreamOptions options, Crowd& crowd);

}  // namespace vitrine
