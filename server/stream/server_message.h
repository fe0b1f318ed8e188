// SPDX-License-Identifier: Apache-2.0
// The messages that the server sends in the protocol pmesh.v1, as text frames (PROTOCOL.md). No
// I/O.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "codec/core/expected.h"

namespace vitrine::server {

// States that a model is open under the number `model`, and describes this model.
struct ModelMessage {
  std::uint16_t model = 0;
  std::string sha256;  // SHA-256 of the model's file, 64 hexadecimal digits
  std::uint64_t chunks = 0;
  std::uint64_t head_bytes = 0;
  std::uint64_t slice_bytes = 0;  // largest payload of a slice, in bytes
  std::uint64_t credit = 0;       // remaining credit of the connection, in bytes
  // How to present the model, as JSON (client_text()). Empty: as stored, and without notes.
  std::string presentation = {};
  bool operator==(const ModelMessage&) const = default;
};

// Promises the detail that the client will hold when the `seconds` of its request have passed.
// Replaces the last promise.
struct PromiseMessage {
  std::uint16_t model = 0;
  std::uint32_t turn = 0;       // number of the request, chosen by the client
  std::uint32_t level = 0;      // the finest level that the client will hold completely
  std::uint64_t bytes = 0;      // bytes that the client will hold, including the model's head
  std::uint64_t triangles = 0;  // triangles that the client will hold
  double error = 0;             // maximum error of `level`, in model units
  double seconds = 0;           // seconds until the promised data have arrived
  double bytes_per_second = 0;  // rate at which the model's bytes arrive
  bool is_measured = false;     // false if bytes_per_second is a guess before the first measurement
  bool operator==(const PromiseMessage&) const = default;
};

// States that the request is met. The members describe the detail that the client holds once all
// earlier frames have arrived.
struct DoneMessage {
  std::uint16_t model = 0;
  std::uint32_t turn = 0;  // number of the request, chosen by the client
  std::uint64_t bytes = 0, triangles = 0;
  bool operator==(const DoneMessage&) const = default;
};

// States that no model is open under the number `model`: it was closed or could not be opened.
struct ClosedMessage {
  std::uint16_t model = 0;
  std::string reason;
  bool operator==(const ClosedMessage&) const = default;
};

using ServerMessage = std::variant<ModelMessage, PromiseMessage, DoneMessage, ClosedMessage>;

std::string to_json(const ServerMessage& message);

// Parses one message of the server, for clients. Safe on hostile input: time and memory are linear
// in the length, which the caller must limit.
Expected<ServerMessage> parse_server_message(std::string_view text);

}  // namespace vitrine::server
