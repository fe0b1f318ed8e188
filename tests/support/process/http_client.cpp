// SPDX-License-Identifier: Apache-2.0
#include "support/process/http_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <stdexcept>

#include "support/product_names.h"
#include "support/uninterrupted.h"

namespace vitrine::test {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

HttpClient::HttpClient(std::uint16_t port, const char* to) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, to, &address.sin_addr);
  connect(&address, sizeof address);
}

HttpClient::HttpClient(const std::filesystem::path& unix_socket) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  unix_socket.string().copy(address.sun_path, sizeof address.sun_path - 1);
  connect(&address, sizeof address);
}

void HttpClient::connect(const void* address, std::size_t size) {
  const auto* peer = static_cast<const sockaddr*>(address);
  const timeval timeout{.tv_sec = 20, .tv_usec = 0};
  socket_ = ::socket(peer->sa_family, SOCK_STREAM, 0);
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (::connect(socket_, peer, static_cast<socklen_t>(size)) != 0)
    throw std::runtime_error("cannot connect");
}

ssize_t HttpClient::read_some(char* bytes, std::size_t size) {
  return uninterrupted([&] { return ::recv(socket_, bytes, size, 0); });
}

ssize_t HttpClient::write_some(const char* bytes, std::size_t size) {
  return uninterrupted([&] { return ::send(socket_, bytes, size, MSG_NOSIGNAL); });
}

HttpClient::~HttpClient() {
  ::close(socket_);
}

void HttpClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = write_some(bytes.data(), bytes.size());
    if (sent <= 0) throw std::runtime_error("cannot send");
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

bool HttpClient::fill() {
  char bytes[16384];
  const ssize_t count = read_some(bytes, sizeof bytes);
  if (count < 0 && errno == EAGAIN) throw std::runtime_error("no answer");
  if (count > 0) buffer_.append(bytes, static_cast<std::size_t>(count));
  return count > 0;
}

std::string HttpClient::read_exactly(std::size_t count) {
  while (buffer_.size() < count) {
    if (!fill()) throw std::runtime_error("the connection was closed");
  }
  std::string bytes = buffer_.substr(0, count);
  buffer_.erase(0, count);
  return bytes;
}

bool HttpClient::is_closed() {
  return buffer_.empty() && !fill();
}

bool HttpClient::is_reset() const {
  pollfd waiting{socket_, 0, 0};
  return ::poll(&waiting, 1, 20'000) == 1 && (waiting.revents & (POLLERR | POLLHUP)) != 0;
}

HttpAnswer HttpClient::receive(bool with_body) {
  std::size_t end;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) throw std::runtime_error("the connection was closed");
  }
  std::string head = read_exactly(end + 4);
  HttpAnswer answer;
  answer.status = std::stoi(head.substr(9, 3));
  for (std::size_t at = head.find("\r\n") + 2; at + 2 < head.size();) {
    const std::size_t line_end = head.find("\r\n", at);
    const std::size_t colon = head.find(':', at);
    answer.fields[lower(head.substr(at, colon - at))] =
        head.substr(colon + 2, line_end - colon - 2);
    at = line_end + 2;
  }
  const std::string length = answer.field("content-length");
  if (with_body && !length.empty()) answer.body = read_exactly(std::stoul(length));
  return answer;
}

HttpAnswer HttpClient::get(const std::string& target, const std::string& fields,
                           const std::string& method) {
  send(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n");
  return receive(method != "HEAD");
}

HttpAnswer http_get(std::uint16_t port, const std::string& target, const std::string& fields,
                    const std::string& method) {
  return HttpClient(port).get(target, fields, method);
}

std::string masked_frame(std::uint8_t first, std::string_view payload) {
  std::string frame(1, static_cast<char>(first));
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80 | payload.size());
  } else if (payload.size() < 65536) {
    frame += static_cast<char>(0x80 | 126);
    for (int shift : {8, 0})
      frame += static_cast<char>(payload.size() >> shift);
  } else {
    frame += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8)
      frame += static_cast<char>(payload.size() >> shift);
  }
  frame.append(4, '\0');
  return frame.append(payload);
}

WebSocketClient::WebSocketClient(std::unique_ptr<HttpClient> client, const std::string& target,
                                 const std::string& subprotocol, const std::string& fields)
    : client_(std::move(client)) {
  const HttpAnswer answer =
      client_->get(target,
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: " +
                       subprotocol + "\r\n" + fields);
  if (answer.status != 101 || answer.field("sec-websocket-protocol") != subprotocol) {
    throw std::runtime_error("no upgrade: " + std::to_string(answer.status) + " " + answer.body);
  }
}

WebSocketFrame WebSocketClient::receive() {
  const std::string head = client_->read_exactly(2);
  std::size_t length = static_cast<unsigned char>(head[1]) & 0x7f;
  const std::size_t more = length == 126 ? 2 : length == 127 ? 8 : 0;
  if (more > 0) {
    length = 0;
    for (const char byte : client_->read_exactly(more)) {
      length = (length << 8) | static_cast<unsigned char>(byte);
    }
  }
  return {static_cast<WebSocketFrame::FrameKind>(head[0] & 0x0f), client_->read_exactly(length)};
}

}  // namespace vitrine::test
