// SPDX-License-Identifier: Apache-2.0
// What comes of a wish for `seconds`, and which promises were kept when: by what has arrived, not
// by what the server says of it.
#pragma once

#include <limits>
#include <vector>

#include "codec/progressive/manifest.h"
#include "stream_peer.h"

namespace vitrine::bench {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct HeardPromise {
  PromiseMessage promise;
  double at;             // when it came, seconds
  double kept = kNever;  // when all that it names was there

  double ratio() const { return (kept - at) / promise.seconds; }
};

class WishCourse {
 public:
  // Of a client that has the head.
  explicit WishCourse(const Manifest& manifest);

  void take(const StreamPeer::Event& event);

  std::uint64_t received() const { return received_; }  // bytes of chunks
  std::uint32_t level() const;                          // that is there everywhere
  bool is_done() const { return done_ != kNever; }
  double done() const { return done_; }  // when the server said so
  const std::vector<HeardPromise>& promises() const { return promises_; }

 private:
  bool keeps(const PromiseMessage& promise) const;

  std::uint64_t head_, received_ = 0;
  std::vector<std::size_t> missing_;  // chunks of each level
  std::vector<HeardPromise> promises_;
  double done_ = kNever;
};

}  // namespace vitrine::bench
