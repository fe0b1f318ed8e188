// SPDX-License-Identifier: Apache-2.0
// The state of one model on one client's stream: the detail request, the chunks that the client
// holds, and the chunk being sent. Chooses what to send next. Does no I/O and reads no clock.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "codec/core/expected.h"
#include "codec/plan/planner.h"
#include "server/stream/message.h"
#include "server/stream/pacer.h"
#include "server/stream/server_message.h"
#include "server/stream/slice.h"

namespace vitrine::server {

using StreamOutput = std::variant<std::monostate, Slice, PromiseMessage, DoneMessage>;

// The connection's pacer, and the number of models that share the connection. All models that have
// something to send get equal shares.
struct Share {
  const Pacer& pacer;
  std::size_t sharers = 1;  // number of models that have something to send, including this one

  // Returns the seconds until all bytes in flight, and then `bytes` of this model, have arrived.
  // `rate` is the connection's rate in bytes per second.
  double seconds(std::uint64_t bytes, double rate) const {
    return (static_cast<double>(pacer.in_flight()) +
            static_cast<double>(bytes) * static_cast<double>(sharers)) /
           rate;
  }
};

class ModelStream {
 public:
  // The manifest must outlive this object. Before the first detail request, sends only the model's
  // head (Manifest::head_bytes()), and only if `sends_head` is true.
  ModelStream(std::uint16_t number, const Manifest& manifest, bool sends_head)
      : number_(number), manifest_(&manifest), sends_head_(sends_head) {}

  std::uint16_t number() const { return number_; }

  void want(const WantMessage& message, Pacer::Time now);
  // Marks chunks as held by the client. Fails with kBadInput if the model has no such chunk.
  Expected<void> have(const std::vector<ChunkRange>& chunks);
  void set_paused(bool is_paused);

  // Returns the next slice of at most `most` bytes, or a message. If `most` is 0, returns no slice.
  // Returns std::monostate if there is nothing to send now.
  StreamOutput next(std::uint32_t most, const Share& share, Pacer::Time now);

  // Whether next() may return slices.
  bool is_sending() const { return (sends_head_ || is_open_) && !is_paused_; }
  // Whether a `seconds` request is open, so that next() may return a new promise as time passes.
  bool is_timed() const { return is_open_ && timed_.has_value() && !is_paused_; }

 private:
  struct StartedChunk {
    std::size_t chunk;
    std::uint64_t offset;  // number of bytes already sent
  };
  struct Timed {
    double seconds;
    Pacer::Time deadline;
    std::optional<PromiseMessage> promise;  // the last promise sent
    Pacer::Time promised{};
  };
  // Seconds until all bytes in flight have arrived, without and with the next chunk.
  struct Ends {
    double without, with;
  };

  Planner& planner();
  void interrupt();
  bool is_within_chunk() const { return under_way_ && under_way_->offset > 0; }
  bool choose(const Share& share, Pacer::Time now);
  std::uint64_t left_of(std::size_t chunk) const;
  bool is_in_time(Ends ends, Pacer::Time now) const;
  std::optional<PromiseMessage> news(const Share& share, Pacer::Time now);
  PromiseMessage forecast(const Share& share, Pacer::Time now) const;
  StreamOutput head_slice(std::uint32_t most);
  StreamOutput chunk_slice(std::uint32_t most);

  std::uint16_t number_;
  const Manifest* manifest_;
  bool sends_head_;  // true until the model's whole head has been sent
  std::uint64_t head_sent_ = 0;
  std::optional<Planner> planner_;  // created with the first detail request
  std::uint32_t turn_ = 0;          // number of the detail request, chosen by the client
  bool is_open_ = false;            // true until the request has been answered with `done`
  bool is_paused_ = false;
  std::optional<Timed> timed_;             // set if the request is for `seconds`
  std::optional<StartedChunk> under_way_;  // the chunk being sent
  // Chunks whose sending was interrupted by new requests. Only the remaining bytes of each are sent
  // later.
  std::vector<StartedChunk> interrupted_;
};

}  // namespace vitrine::server
