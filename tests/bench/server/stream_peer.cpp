// SPDX-License-Identifier: Apache-2.0
#include "stream_peer.h"
#include "support/product_names.h"

#include <stdexcept>

namespace vitrine::bench {

StreamPeer::Event StreamPeer::next() {
  for (;;) {
    const test::WebSocketFrame frame = client_.receive();
    Event event{.at = now()};
    if (frame.kind == test::WebSocketFrame::kPing) continue;
    if (frame.kind == test::WebSocketFrame::kText) {
      event.message = parse_server_message(frame.payload).value();
      return event;
    }
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(frame.payload.data()),
                          frame.payload.size());
    event.slice = parse_slice(bytes);
    if (!event.slice) throw std::runtime_error("the stream ended: " + frame.payload);
    event.bytes = bytes.size() - kSliceHeader;
    if (event.slice->level == 0) head.insert(head.end(), bytes.begin() + kSliceHeader, bytes.end());
    say(AckMessage{event.bytes});
    return event;
  }
}

}  // namespace vitrine::bench
