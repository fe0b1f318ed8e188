// SPDX-License-Identifier: Apache-2.0
#include "detail_progress.h"
#include "support/product_names.h"

namespace vitrine::bench {

DetailProgress::DetailProgress(const Manifest& manifest)
    : head_(manifest.head_bytes()), missing_(manifest.levels.size()) {
  for (const ChunkInfo& chunk : manifest.chunks)
    ++missing_[chunk.level];
}

std::uint32_t DetailProgress::level() const {
  std::uint32_t level = 0;
  while (level + 1 < missing_.size() && missing_[level + 1] == 0)
    ++level;
  return level;
}

bool DetailProgress::keeps(const PromiseMessage& promise) const {
  return head_ + received_ >= promise.bytes && level() >= promise.level;
}

void DetailProgress::take(const StreamPeer::Event& event) {
  received_ += event.bytes;
  if (event.slice && event.slice->offset + event.bytes == event.slice->total)
    --missing_[event.slice->level];
  if (event.message) {
    if (const auto* promise = std::get_if<PromiseMessage>(&*event.message))
      forecasts_.push_back({*promise, event.at});
    if (std::holds_alternative<DoneMessage>(*event.message)) done_ = event.at;
  }
  for (ReceivedForecast& heard : forecasts_) {
    if (heard.kept == kNever && keeps(heard.promise)) heard.kept = event.at;
  }
}

}  // namespace vitrine::bench
