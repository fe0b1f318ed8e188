// SPDX-License-Identifier: Apache-2.0
// Two network namespaces, the server's and the client's, joined by one link whose way to the client
// is shaped. Needs the right to make namespaces (root), ip and tc.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "codec/files/file_descriptor.h"
#include "delay_line.h"

namespace vitrine::bench {

inline constexpr std::chrono::milliseconds kLongWay{150};  // there and back

class ShapedLink {
 public:
  // `round_trip`: of a packet and its answer. This thread, and what it starts, is in the server's
  // namespace until at_client(). Throws where the kernel or a tool refuses.
  explicit ShapedLink(std::chrono::milliseconds round_trip = {});
  ~ShapedLink();
  ShapedLink(const ShapedLink&) = delete;
  ShapedLink& operator=(const ShapedLink&) = delete;

  void at_server() const;
  void at_client() const;
  void shape(double bytes_per_second);  // ends at_client()

  static constexpr const char* kServer = "10.99.0.1";

 private:
  void join_at_once();
  void join_late(std::chrono::milliseconds round_trip);

  FileDescriptor before_, server_, client_;
  std::optional<DelayLine> line_;
  bool is_shaped_ = false;
};

}  // namespace vitrine::bench
