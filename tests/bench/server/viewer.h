// SPDX-License-Identifier: Apache-2.0
// One WebSocket that does not block.
#pragma once

#include <cstdint>
#include <string>

#include "codec/files/file_descriptor.h"

namespace vitrine::bench {

// Throws where it is cut.
class Viewer {
 public:
  // Of the model of that id, at 127.0.0.1; `host` is whom it asks there.
  Viewer(std::uint16_t port, const std::string& model, const std::string& host = "localhost");

  int socket() const { return socket_.get(); }
  std::uint64_t payload() const { return payload_; }

  void say(const std::string& text);
  void greet();   // waits for the greeting
  void refine();  // takes what is there and acknowledges its slices

 private:
  void send(const std::string& bytes);
  void receive(int flags);
  std::size_t frame_at(std::size_t at) const;

  FileDescriptor socket_;
  std::string buffer_;
  std::uint64_t payload_ = 0;
};

}  // namespace vitrine::bench
