// SPDX-License-Identifier: Apache-2.0
// The text messages of pmesh.v1 (PROTOCOL.md). Pure.
#pragma once

#include <cstdint>
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

struct ChunkRange {
  std::uint64_t first = 0, last = 0;  // inclusive, first <= last
};
struct HaveMessage {
  std::vector<ChunkRange> chunks;  // ascending and disjoint
};
struct AckMessage {
  std::uint64_t bytes = 0;  // 1..kMaxAck
};
using ClientMessage = std::variant<Want, HaveMessage, AckMessage>;

// Parses one client message. Safe on hostile bytes: work and memory are linear in the length, which
// the caller bounds by kMaxMessage. The error's message fits a WebSocket close frame (123 bytes).
Expected<ClientMessage> parse_message(std::string_view text);

struct ModelMessage {
  std::string sha256;
  std::uint64_t chunks = 0;
  std::uint64_t slice_bytes = 0;
  std::uint64_t credit = 0;
};
std::string to_json(const ModelMessage& message);

struct DoneMessage {
  std::uint64_t bytes = 0, triangles = 0;
  bool operator==(const DoneMessage&) const = default;
};
std::string to_json(const DoneMessage& message);

}  // namespace vitrine
