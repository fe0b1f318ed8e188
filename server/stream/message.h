// SPDX-License-Identifier: Apache-2.0
// The messages that a client sends in the protocol pmesh.v1, as text frames (PROTOCOL.md). No I/O.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "codec/core/expected.h"
#include "codec/plan/planner.h"

namespace vitrine::server {

inline constexpr std::size_t kMaxMessage = 64 * 1024;
inline constexpr std::size_t kMaxHaveRanges = 4096;
inline constexpr std::uint64_t kMaxAck = 16u << 20;
inline constexpr std::uint16_t kMaxModels = 16;  // open models per connection, numbered from 0
inline constexpr std::size_t kMaxIdText = 64;
inline constexpr double kMaxSeconds = 3600;

// Asks for as much detail as can arrive within this time.
struct WantSeconds {
  double seconds = 0;  // above 0, at most kMaxSeconds
};
using DetailTarget = std::variant<Want, WantSeconds>;

struct ChunkRange {
  std::uint64_t first = 0, last = 0;  // both ends are included; first <= last
};

// Asks the server to open a model. `model` is the number that the model gets in this connection,
// below kMaxModels.
struct OpenMessage {
  std::uint16_t model = 0;
  std::string id;  // the model's ID, as in URLs; the parser checks only its length
  bool wants_head = false;
};
struct CloseMessage {
  std::uint16_t model = 0;
};
struct WantMessage {
  std::uint16_t model = 0;
  // Number of the request, chosen by the client; the server repeats it in its answers.
  std::uint32_t turn = 0;
  DetailTarget target;
};
struct HaveMessage {
  std::uint16_t model = 0;
  std::vector<ChunkRange> chunks;  // in ascending order, disjoint
};
struct PauseMessage {
  std::uint16_t model = 0;
  bool is_pause = true;  // true to pause, false to resume
};
struct AckMessage {
  std::uint64_t bytes = 0;  // 1..kMaxAck
};
using ClientMessage =
    std::variant<OpenMessage, CloseMessage, WantMessage, HaveMessage, PauseMessage, AckMessage>;

// Parses one client message. Safe on hostile bytes: work and memory are linear in the length, which
// the caller must limit to kMaxMessage. The message of the error fits into a WebSocket close frame
// (123 bytes).
Expected<ClientMessage> parse_message(std::string_view text);

// Splits ascending ranges into messages that stay within the limits kMaxHaveRanges and kMaxMessage.
std::vector<HaveMessage> have_messages(std::uint16_t model, std::span<const ChunkRange> chunks);

// Formats a message as JSON, which parse_message() can read.
std::string to_json(const ClientMessage& message);

}  // namespace vitrine::server
