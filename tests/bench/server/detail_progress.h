// SPDX-License-Identifier: Apache-2.0
// Follows a detail request on the client's side. The request asks for the detail that can arrive
// within a number of seconds. Records the data that has arrived, and when each of the server's
// forecasts came true.
#pragma once

#include <limits>
#include <vector>

#include "codec/format/manifest.h"
#include "stream_peer.h"
#include "support/product_names.h"

namespace vitrine::bench {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct ReceivedForecast {
  PromiseMessage promise;
  double at;             // time in seconds at which the forecast arrived
  double kept = kNever;  // time in seconds at which all data of the forecast had arrived

  double ratio() const { return (kept - at) / promise.seconds; }
};

class DetailProgress {
 public:
  // Assumes that the client has already received the model's head: the header and the base mesh.
  explicit DetailProgress(const Manifest& manifest);

  void take(const StreamPeer::Event& event);

  std::uint64_t received() const { return received_; }  // bytes of chunks received so far
  std::uint32_t level() const;  // the finest level that is complete in all regions
  bool is_done() const { return done_ != kNever; }
  double done() const { return done_; }  // time in seconds at which the server reported completion
  const std::vector<ReceivedForecast>& forecasts() const { return forecasts_; }

 private:
  bool keeps(const PromiseMessage& promise) const;

  std::uint64_t head_, received_ = 0;
  std::vector<std::size_t> missing_;  // number of missing chunks of each level
  std::vector<ReceivedForecast> forecasts_;
  double done_ = kNever;
};

}  // namespace vitrine::bench
