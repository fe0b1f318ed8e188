// SPDX-License-Identifier: Apache-2.0
// What a server knows of one client of pmesh.v1: its wish, what it holds, its credit; and from
// these, what to send next. Pure: no I/O, no clock.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "codec/core/expected.h"
#include "codec/progressive/planner.h"
#include "server/stream/message.h"
#include "server/stream/slice.h"

namespace vitrine {

inline constexpr std::uint64_t kFirstCredit = 64 * 1024;
inline constexpr std::uint64_t kMaxCredit = 64u << 20;  // more grants are lost

class StreamState {
 public:
  // The manifest outlives this. Nothing is wanted yet.
  explicit StreamState(const Manifest& manifest) : manifest_(&manifest), planner_(manifest) {}

  // Fails with kBadInput where the message does not fit the model.
  Expected<void> receive(const ClientMessage& message);

  using Output = std::variant<std::monostate, Slice, DoneMessage>;
  // What to send now; nothing until a further message arrives. A slice is chosen only now and takes
  // its credit, so a new wish or a `have` counts from the next chunk on.
  Output next();

  std::uint64_t credit() const { return credit_; }

 private:
  Expected<void> receive_have(const HaveMessage& have);
  Output next_slice();

  const Manifest* manifest_;
  Planner planner_;
  std::uint64_t credit_ = kFirstCredit;
  std::optional<Slice> under_way_;  // of the chunk being sent: what comes next
  bool open_want_ = false;          // a wish that has not been answered by `done`
};

}  // namespace vitrine
