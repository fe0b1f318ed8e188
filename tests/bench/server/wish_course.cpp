// SPDX-License-Identifier: Apache-2.0
#include "wish_course.h"

namespace vitrine::bench {

WishCourse::WishCourse(const Manifest& manifest)
    : head_(manifest.head_bytes()), missing_(manifest.levels.size()) {
  for (const ChunkInfo& chunk : manifest.chunks)
    ++missing_[chunk.level];
}

std::uint32_t WishCourse::level() const {
  std::uint32_t level = 0;
  while (level + 1 < missing_.size() && missing_[level + 1] == 0)
    ++level;
  return level;
}

bool WishCourse::keeps(const PromiseMessage& promise) const {
  return head_ + received_ >= promise.bytes && level() >= promise.level;
}

void WishCourse::take(const StreamPeer::Event& event) {
  received_ += event.bytes;
  if (event.slice && event.slice->offset + event.bytes == event.slice->total)
    --missing_[event.slice->level];
  if (event.message) {
    if (const auto* promise = std::get_if<PromiseMessage>(&*event.message))
      promises_.push_back({*promise, event.at});
    if (std::holds_alternative<DoneMessage>(*event.message)) done_ = event.at;
  }
  for (HeardPromise& heard : promises_) {
    if (heard.kept == kNever && keeps(heard.promise)) heard.kept = event.at;
  }
}

}  // namespace vitrine::bench
