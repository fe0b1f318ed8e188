// SPDX-License-Identifier: Apache-2.0
// What a server knows of one model of one client: the wish, what is held, what is under way; and
// from these, what to send next. Pure: no I/O, no clock.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/planner.h"
#include "server/stream/message.h"
#include "server/stream/pacer.h"
#include "server/stream/server_message.h"
#include "server/stream/slice.h"

namespace vitrine {

using StreamOutput = std::variant<std::monostate, Slice, PromiseMessage, DoneMessage>;

// A connection as one of the models on it has it: they get the same number of bytes.
struct Share {
  const Pacer& pacer;
  std::size_t sharers = 1;  // models that have something to send, this one included

  // How long it takes until all that is on its way has arrived, and then `bytes` of this model's.
  double seconds(std::uint64_t bytes, double rate) const {
    return (static_cast<double>(pacer.in_flight()) +
            static_cast<double>(bytes) * static_cast<double>(sharers)) /
           rate;
  }
};

class ModelStream {
 public:
  // The manifest outlives this. Nothing is wanted yet but, where `head` is set, the head.
  ModelStream(std::uint16_t number, const Manifest& manifest, bool head)
      : number_(number), manifest_(&manifest), head_(head) {}

  std::uint16_t number() const { return number_; }

  void want(const WantMessage& message, Pacer::Time now);
  // Fails with kBadInput where the model has no such chunk.
  Expected<void> have(const std::vector<ChunkRange>& chunks);
  void pause(bool pause);

  // A slice of at most `most` bytes (none where that is 0), or what there is to say; nothing
  // until something changes.
  StreamOutput next(std::uint32_t most, const Share& share, Pacer::Time now);

  // next() may have slices.
  bool is_sending() const { return (head_ || is_open_) && !is_paused_; }
  // A wish for `seconds` is open: next() may have something new to say as time passes.
  bool is_timed() const { return is_open_ && timed_.has_value() && !is_paused_; }

 private:
  struct Part {
    std::size_t chunk;
    std::uint64_t offset;  // sent up to here
  };
  struct Timed {
    double seconds;
    Pacer::Time deadline;
    std::optional<PromiseMessage> promise;  // the newest
    Pacer::Time promised{};
  };
  // How long sending takes from now on, with a chunk and without it.
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
  bool head_;  // is to be sent, or the rest of it
  std::uint64_t head_sent_ = 0;
  std::optional<Planner> planner_;  // from the first message on: those who only look on have none
  std::uint32_t turn_ = 0;          // of the wish
  bool is_open_ = false;            // the wish has not been answered by `done`
  bool is_paused_ = false;
  std::optional<Timed> timed_;     // the wish is for seconds
  std::optional<Part> under_way_;  // the chunk being sent
  std::vector<Part> interrupted_;  // by new wishes: if they are sent, it is the rest
};

}  // namespace vitrine
