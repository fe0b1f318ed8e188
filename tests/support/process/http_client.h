// SPDX-License-Identifier: Apache-2.0
// An HTTP client that sends exactly the given bytes, and a WebSocket client on top of it.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::test {

struct HttpAnswer {
  int status = 0;
  std::map<std::string, std::string> fields;  // names in lower case
  std::string body;

  std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }
};

inline constexpr const char* kLoopback = "127.0.0.1";

// One connection to a port or to a Unix socket. Calls block, and throw after 20 s without a
// response.
class HttpClient {
 public:
  explicit HttpClient(std::uint16_t port, const char* address = kLoopback);
  explicit HttpClient(const std::filesystem::path& unix_socket);
  virtual ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  void send(std::string_view bytes);
  HttpAnswer receive(bool with_body = true);
  // Sends a request with a Host field and the given fields ("Name: value\r\n"...). Returns the
  // response.
  HttpAnswer get(const std::string& target, const std::string& fields = "",
                 const std::string& method = "GET");
  bool is_closed();       // waits for bytes or the end of the stream; true at the end
  bool is_reset() const;  // waits for a reset, without reading; returns false after 20 s

  std::string read_exactly(std::size_t count);

 protected:
  int socket() const { return socket_; }

 private:
  virtual ssize_t read_some(char* bytes, std::size_t size);  // reads like recv(2)
  virtual ssize_t write_some(const char* bytes, std::size_t size);
  void connect(const void* address, std::size_t size);
  bool fill();  // reads more bytes; returns false at the end of the stream

  int socket_;
  std::string buffer_;
};

// Opens a new connection for one request and returns the response.
HttpAnswer http_get(std::uint16_t port, const std::string& target, const std::string& fields = "",
                    const std::string& method = "GET");

struct WebSocketFrame {
  enum FrameKind { kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 } kind;
  std::string payload;

  int close_code() const {  // the code in the payload of a kClose frame
    return (static_cast<unsigned char>(payload.at(0)) << 8) |
           static_cast<unsigned char>(payload.at(1));
  }
};

// Returns a client's frame, masked with zeros ([RFC6455] section 5.2). `first` is its first byte:
// FIN, reserved bits and opcode.
std::string masked_frame(std::uint8_t first, std::string_view payload);

class WebSocketClient {
 public:
  // Throws unless the server responds with 101 and the subprotocol.
  WebSocketClient(std::uint16_t port, const std::string& target, const std::string& subprotocol,
                  const std::string& fields = "", const char* address = kLoopback)
      : WebSocketClient(std::make_unique<HttpClient>(port, address), target, subprotocol, fields) {}
  WebSocketClient(std::unique_ptr<HttpClient> client, const std::string& target,
                  const std::string& subprotocol, const std::string& fields = "");

  void send_text(std::string_view text) { send(0x81, text); }
  void send_binary(std::string_view bytes) { send(0x82, bytes); }
  WebSocketFrame receive();
  void send_close() { send(0x88, std::string_view("\x03\xe8", 2)); }
  void send(std::uint8_t first, std::string_view payload) {
    send_raw(masked_frame(first, payload));
  }
  void send_raw(std::string_view bytes) { client_->send(bytes); }
  bool is_closed() { return client_->is_closed(); }

 private:
  std::unique_ptr<HttpClient> client_;
};

}  // namespace vitrine::test
