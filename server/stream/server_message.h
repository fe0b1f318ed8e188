// SPDX-License-Identifier: Apache-2.0
// What servers of pmesh.v1 say: its text frames (PROTOCOL.md). Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "codec/core/expected.h"

namespace vitrine {

// A model is open: what its number stands for.
struct ModelMessage {
  std::uint16_t model = 0;
  std::string sha256;  // of its file, 64 hexadecimal digits
  std::uint64_t chunks = 0;
  std::uint64_t head_bytes = 0;
  std::uint64_t slice_bytes = 0;  // a slice's payload has no more
  std::uint64_t credit = 0;       // that the connection has left
  bool operator==(const ModelMessage&) const = default;
};

// What will be there in time, of a wish for `seconds`. Each replaces the one before.
struct PromiseMessage {
  std::uint16_t model = 0;
  std::uint32_t turn = 0;       // of the wish
  std::uint32_t level = 0;      // that is complete then
  std::uint64_t bytes = 0;      // held then, head included
  std::uint64_t triangles = 0;  // held then
  double error = 0;             // of that level, model units
  double seconds = 0;           // from now
  double bytes_per_second = 0;  // of the connection
  bool measured = false;        // else that is a first guess
  bool operator==(const PromiseMessage&) const = default;
};

// The wish is met: what the client holds once it has what was sent before this.
struct DoneMessage {
  std::uint16_t model = 0;
  std::uint32_t turn = 0;  // of the wish
  std::uint64_t bytes = 0, triangles = 0;
  bool operator==(const DoneMessage&) const = default;
};

// The number stands for no model (any more).
struct ClosedMessage {
  std::uint16_t model = 0;
  std::string reason;
  bool operator==(const ClosedMessage&) const = default;
};

using ServerMessage = std::variant<ModelMessage, PromiseMessage, DoneMessage, ClosedMessage>;

std::string to_json(const ServerMessage& message);

// For clients: parses one message. Safe on hostile bytes: work and memory are linear in the length,
// which the caller bounds.
Expected<ServerMessage> parse_server_message(std::string_view text);

}  // namespace vitrine
