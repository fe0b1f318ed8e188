// SPDX-License-Identifier: Apache-2.0
// A client of pmesh.v1 that acknowledges slices and records their times of arrival.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "server/stream/message.h"
#include "server/stream/server_message.h"
#include "server/stream/slice.h"
#include "support/process/http_client.h"
#include "support/product_names.h"

namespace vitrine::bench {

class StreamPeer {
 public:
  // Connects to the stream of a model. The server sends the model's head first if the query string
  // `query` requests it.
  StreamPeer(std::uint16_t port, const std::string& model, const char* address,
             const std::string& query = "")
      : client_(port, "/api/v1/models/" + model + "/stream" + query, "pmesh.v1", "", address) {}

  void say(const ClientMessage& message) { client_.send_text(to_json(message)); }

  struct Event {
    std::optional<SliceHeader> slice = {};
    std::size_t bytes = 0;  // length of the slice's payload
    std::optional<ServerMessage> message = {};
    double at = 0;  // time in seconds at which the message or slice arrived
  };
  Event next();

  std::vector<std::uint8_t> head;  // bytes of the head received so far
  static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

 private:
  test::WebSocketClient client_;
};

}  // namespace vitrine::bench
