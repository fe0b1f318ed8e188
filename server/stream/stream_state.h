// SPDX-License-Identifier: Apache-2.0
// The state of one client of pmesh.v1: its models, its credit (the bytes that it allows the server
// to send) and its pace. Chooses what to send next. Does no I/O and reads no clock: the caller
// passes the time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/stream/model_stream.h"

namespace vitrine::server {

inline constexpr std::uint64_t kFirstCredit = 64 * 1024;
inline constexpr std::uint64_t kMaxCredit = 64u << 20;  // in bytes; credit beyond this is ignored

class StreamState {
 public:
  using Time = Pacer::Time;

  // Opens a model. The manifest must outlive the open model. Fails (kBadInput) if another open
  // model has the number.
  Expected<void> open(std::uint16_t model, const Manifest& manifest, bool sends_head);

  // Handles any message except an OpenMessage, for which the caller calls open(). Fails with
  // kBadInput if the message refers to a model that is not open or a chunk that does not exist.
  Expected<void> receive(const ClientMessage& message, Time now);

  // Returns the next output, or std::monostate if there is none until the next message or wakes().
  // A slice is chosen and charged to the credit only here, so that a new request or a `have` takes
  // effect at once. Models that have something to send get equal shares, slice by slice.
  // `busy_streams` is the number of the daemon's busy streams, including this one.
  StreamOutput next(Time now, std::size_t busy_streams = 1);
  // Whether bytes are in flight.
  bool is_busy() const { return pacer_.in_flight() > 0; }

  // Returns the time at which next() may have an output without a further message. Returns nullopt
  // if there is no such time.
  std::optional<Time> wakes(Time now) const;

  // Whether the client has granted credit for more bytes than were sent. Acknowledgements then do
  // not show which bytes have arrived, so the caller must call still_queued() from time to time.
  bool is_granted_ahead() const { return granted_ > sent_; }
  // Reports the number of bytes still queued in the kernel. Counts the other sent bytes as arrived.
  void still_queued(std::uint64_t bytes, Time now);

  // Sets the round-trip time of the connection itself. Call this only if there is no proxy between
  // server and client.
  void know_delay(Pacer::Duration own) { pacer_.know_delay(own); }

  std::uint64_t credit() const { return credit_; }

 private:
  struct Sharer {
    ModelStream stream;
    // Bytes sent for this model. After an idle time, raised to the count of the models that were
    // sending.
    std::uint64_t served;
  };

  Sharer* find(std::uint16_t model);
  Expected<void> receive_one(const CloseMessage& message, Time now);
  Expected<void> receive_one(const WantMessage& message, Time now);
  Expected<void> receive_one(const HaveMessage& message, Time now);
  Expected<void> receive_one(const PauseMessage& message, Time now);
  Expected<void> receive_one(const AckMessage& message, Time now);
  Expected<void> receive_one(const OpenMessage& message, Time now);
  template <class Do>
  Expected<void> with_model(std::uint16_t number, const Do& act);
  std::uint32_t room(Time now, std::size_t busy_streams);
  void serve(Sharer& model, std::uint32_t bytes, Time now);

  std::vector<Sharer> models_;  // sorted by `served`, the least first
  std::uint64_t credit_ = kFirstCredit;
  std::uint64_t granted_ = 0, sent_ = 0;  // bytes granted by acks; bytes sent in slices
  bool is_held_ = false;  // whether the pacer holds back data for which there is credit
  Pacer pacer_;
};

}  // namespace vitrine::server
