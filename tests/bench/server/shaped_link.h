// SPDX-License-Identifier: Apache-2.0
// Two network namespaces, one for the server and one for the client, joined by a link. The link's
// rate to the client is limited. Needs root, ip and tc.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "codec/files/file_descriptor.h"
#include "delay_line.h"
#include "support/product_names.h"

namespace vitrine::bench {

inline constexpr std::chrono::milliseconds kLongWay{150};  // round-trip time of a distant client

class ShapedLink {
 public:
  // `round_trip` is the time for a packet and its reply. Until at_client() is called, this thread
  // and the processes that it starts are in the server's namespace. Throws if the kernel or a tool
  // refuses.
  explicit ShapedLink(std::chrono::milliseconds round_trip = {});
  ~ShapedLink();
  ShapedLink(const ShapedLink&) = delete;
  ShapedLink& operator=(const ShapedLink&) = delete;

  void at_server() const;
  void at_client() const;
  // Limits the rate to the client. Afterwards, this thread is in the client's namespace.
  void shape(double bytes_per_second);

  static constexpr const char* kServer = "10.99.0.1";

 private:
  void join_at_once();
  void join_late(std::chrono::milliseconds round_trip);

  FileDescriptor before_, server_, client_;
  std::optional<DelayLine> line_;
  bool is_shaped_ = false;
};

}  // namespace vitrine::bench
