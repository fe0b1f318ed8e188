// SPDX-License-Identifier: Apache-2.0
// Passes arbitrary bytes to both ends of a pmesh.v1 stream. A server with a small model receives
// each line of the input as a message. A client receives the whole input as a message and as a
// slice.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "server/stream/server_message.h"
#include "server/stream/stream_state.h"

namespace {

using namespace vitrine;

using namespace vitrine::server;

constexpr std::uint32_t kChunk = 40'000;
constexpr std::size_t kMostSteps = 64;  // maximum number of outputs to take after each message

void check(bool holds) {
  if (!holds) std::abort();
}

Manifest small_manifest() {
  Manifest manifest;
  manifest.base_offset = 600;
  manifest.base_length = 400;
  for (std::uint32_t level = 0; level < 5; ++level) {
    manifest.levels.push_back(
        {.vertices = 50 * (level + 1), .faces = 100 * (level + 1), .max_error = 1.0 / (level + 1)});
    if (level == 0) continue;
    manifest.chunks.push_back({.level = level,
                               .offset = 1000 + (level - 1) * kChunk,
                               .length = kChunk,
                               .splits = 50,
                               .max_error = 1.0 / (level + 1)});
  }
  manifest.file_bytes = 1000 + 4 * kChunk;
  return manifest;
}

// Takes at most kMostSteps of the ready outputs. Each slice must lie within the file and must not
// exceed the client's credit.
void pull(StreamState& state, const Manifest& manifest, Pacer::Time now) {
  for (std::size_t step = 0; step < kMostSteps; ++step) {
    const std::uint64_t credit = state.credit();
    const StreamOutput output = state.next(now);
    if (std::holds_alternative<std::monostate>(output)) return;
    const auto* slice = std::get_if<Slice>(&output);
    if (slice == nullptr) continue;
    check(slice->length > 0 && slice->length <= kMaxSlice && slice->length <= credit);
    check(slice->at + slice->length <= manifest.file_bytes);
    check(slice->header.offset + slice->length <= slice->header.total);
  }
}

void serve(std::string_view text) {
  static const Manifest manifest = small_manifest();
  StreamState state;
  check(state.open(0, manifest, true).has_value());
  Pacer::Time now{Pacer::Duration(1)};
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const auto message = parse_message(line);
    if (!message) {
      check(message.error().message.size() <= 123);
      continue;
    }
    const auto again = parse_message(to_json(*message));
    check(again.has_value() && to_json(*again) == to_json(*message));
    if (const auto* open = std::get_if<OpenMessage>(&*message)) {
      (void)state.open(open->model, manifest, open->wants_head);
    } else {
      (void)state.receive(*message, now);
    }
    pull(state, manifest, now);
    now += Pacer::Duration(0.05);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  serve(text);
  if (const auto message = parse_server_message(text)) to_json(*message);
  if (const auto slice = parse_slice({data, size})) {
    check(slice->offset + (size - kSliceHeader) <= slice->total);
  }
  return 0;
}
