// SPDX-License-Identifier: Apache-2.0
// What a server knows of one client of pmesh.v1: its models, its credit and its pace; and from
// these, what to send next. Pure: no I/O; the caller tells the time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/stream/model_stream.h"

namespace vitrine {

inline constexpr std::uint64_t kFirstCredit = 64 * 1024;
inline constexpr std::uint64_t kMaxCredit = 64u << 20;  // more grants are lost

class StreamState {
 public:
  using Time = Pacer::Time;

  // The manifest outlives its model. Fails (kBadInput) where the number is taken.
  Expected<void> open(std::uint16_t model, const Manifest& manifest, bool head);

  // Anything but an OpenMessage, which is the caller's to answer with open(). Fails with kBadInput
  // where the message does not fit what is open.
  Expected<void> receive(const ClientMessage& message, Time now);

  // What to send now; nothing before a further message or wakes(). A slice is chosen only now and
  // takes its credit, so a new wish or a `have` counts at once. Models that have something to send
  // get equal shares, slice by slice. `crowd` is how many streams are busy, this one included.
  StreamOutput next(Time now, std::size_t crowd = 1);
  bool is_busy() const { return pacer_.in_flight() > 0; }  // something is on its way

  // When next() may have something although no message has come; nothing: never.
  std::optional<Time> wakes(Time now) const;

  // The client has granted more than it was sent, so its messages do not tell what has arrived:
  // the caller tells what the kernel still holds.
  bool is_granted_ahead() const { return granted_ > sent_; }
  void still_queued(std::uint64_t bytes, Time now);

  // The connection's own delay; to be called where no proxy stands between.
  void know_delay(Pacer::Duration own) { pacer_.know_delay(own); }

  std::uint64_t credit() const { return credit_; }

 private:
  struct Sharer {
    ModelStream stream;
    std::uint64_t served;  // bytes, or as much as those who were sent something while it was idle
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
  std::uint32_t room(Time now, std::size_t crowd);
  void serve(Sharer& model, std::uint32_t bytes, Time now);

  std::vector<Sharer> models_;  // who has been served least comes first
  std::uint64_t credit_ = kFirstCredit;
  std::uint64_t granted_ = 0, sent_ = 0;  // by acks; in slices
  bool is_held_ = false;  // by the pace: something is to be sent, and there is credit for it
  Pacer pacer_;
};

}  // namespace vitrine
