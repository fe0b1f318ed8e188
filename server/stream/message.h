// SPDX-License-Identifier: Apache-2.0
// What clients of pmesh.v1 say: its text frames (PROTOCOL.md). Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/planner.h"

namespace vitrine {

inline constexpr std::size_t kMaxMessage = 64 * 1024;
inline constexpr std::size_t kMaxHaveRanges = 4096;
inline constexpr std::uint64_t kMaxAck = 16u << 20;
inline constexpr std::uint16_t kMaxModels = 16;  // of one connection, numbered from 0
inline constexpr std::size_t kMaxIdText = 64;
inline constexpr double kMaxSeconds = 3600;

// As much as the connection brings in this time.
struct WantSeconds {
  double seconds = 0;  // above 0, at most kMaxSeconds
};
using Wish = std::variant<Want, WantSeconds>;

struct ChunkRange {
  std::uint64_t first = 0, last = 0;  // inclusive, first <= last
};

// `model` is the number of one of the connection's models, below kMaxModels.
struct OpenMessage {
  std::uint16_t model = 0;
  std::string id;  // as in URLs; not checked but for its length
  bool head = false;
};
struct CloseMessage {
  std::uint16_t model = 0;
};
struct WantMessage {
  std::uint16_t model = 0;
  std::uint32_t turn = 0;  // what answers to this wish carries; the client's to choose
  Wish wish;
};
struct HaveMessage {
  std::uint16_t model = 0;
  std::vector<ChunkRange> chunks;  // ascending and disjoint
};
struct PauseMessage {
  std::uint16_t model = 0;
  bool pause = true;  // else: goes on
};
struct AckMessage {
  std::uint64_t bytes = 0;  // 1..kMaxAck
};
using ClientMessage =
    std::variant<OpenMessage, CloseMessage, WantMessage, HaveMessage, PauseMessage, AckMessage>;

// Parses one client message. Safe on hostile bytes: work and memory are linear in the length, which
// the caller bounds by kMaxMessage. The error's message fits a WebSocket close frame (123 bytes).
Expected<ClientMessage> parse_message(std::string_view text);

// As many messages as it takes for ranges that ascend: each is within kMaxHaveRanges and
// kMaxMessage.
std::vector<HaveMessage> have_messages(std::uint16_t model, std::span<const ChunkRange> chunks);

// As parse_message() reads it.
std::string to_json(const ClientMessage& message);

}  // namespace vitrine
