// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <sys/socket.h>

#include <stdexcept>

#include "server/stream/slice.h"
#include "support/process/http_client.h"
#include "support/process/loopback.h"
#include "support/product_names.h"

namespace vitrine::bench {

Viewer::Viewer(std::uint16_t port, const std::string& model, const std::string& host)
    : socket_(test::connect_to(port)) {
  send("GET /api/v1/models/" + model + "/stream HTTP/1.1\r\nHost: " + host +
       "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
       "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
       "Sec-WebSocket-Protocol: pmesh.v1\r\n\r\n");
}

void Viewer::send(const std::string& bytes) {
  if (::send(socket(), bytes.data(), bytes.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("a viewer was cut");
}

void Viewer::say(const std::string& text) {
  send(test::masked_frame(0x81, text));
}

void Viewer::greet() {
  while (buffer_.find("\"type\":\"model\"") == std::string::npos)
    receive(0);
  buffer_.clear();
}

void Viewer::refine() {
  receive(MSG_DONTWAIT);
  std::size_t at = 0, slices = 0;
  while (const std::size_t length = frame_at(at)) {
    if (buffer_[at] == '\x82') slices += length - 4 - kSliceHeader;
    at += length;
  }
  buffer_.erase(0, at);
  payload_ += slices;
  if (slices > 0) say(R"({"type":"ack","bytes":)" + std::to_string(slices) + "}");
}

void Viewer::receive(int flags) {
  char bytes[65536];
  const ssize_t count = ::recv(socket(), bytes, sizeof bytes, flags);
  if (count == 0) throw std::runtime_error("a viewer was cut");
  if (count > 0) buffer_.append(bytes, static_cast<std::size_t>(count));
}

// Returns the length of the frame that starts at `at`, header included, or 0 if the frame is
// incomplete. Slices are between 126 bytes and 64 KiB long, so the header of their frames has 4
// bytes.
std::size_t Viewer::frame_at(std::size_t at) const {
  if (buffer_.size() < at + 4) return 0;
  std::size_t length = static_cast<unsigned char>(buffer_[at + 1]), header = 2;
  if (length == 126) {
    length = static_cast<std::size_t>(static_cast<unsigned char>(buffer_[at + 2])) << 8 |
             static_cast<unsigned char>(buffer_[at + 3]);
    header = 4;
  }
  return buffer_.size() < at + header + length ? 0 : header + length;
}

}  // namespace vitrine::bench
