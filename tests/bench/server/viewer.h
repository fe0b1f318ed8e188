// SPDX-License-Identifier: Apache-2.0
// A WebSocket client on a non-blocking socket.
#pragma once

#include <cstdint>
#include <string>

#include "codec/files/file_descriptor.h"

namespace vitrine::bench {

// A viewer on one connection. Throws if the server closes the connection.
class Viewer {
 public:
  // Connects to the model's stream at 127.0.0.1. `host` is the value of the request's Host field.
  Viewer(std::uint16_t port, const std::string& model, const std::string& host = "localhost");

  int socket() const { return socket_.get(); }
  std::uint64_t payload() const { return payload_; }

  void say(const std::string& text);
  void greet();   // waits for the server's first message
  void refine();  // reads the available frames and acknowledges their slices

 private:
  void send(const std::string& bytes);
  void receive(int flags);
  std::size_t frame_at(std::size_t at) const;

  FileDescriptor socket_;
  std::string buffer_;
  std::uint64_t payload_ = 0;
};

}  // namespace vitrine::bench
