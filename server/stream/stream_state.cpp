// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_state.h"

#include <algorithm>

namespace vitrine {

Expected<void> StreamState::receive(const ClientMessage& message) {
  if (const auto* want = std::get_if<Want>(&message)) {
    planner_.want(*want);
    open_want_ = true;
    return {};
  }
  if (const auto* ack = std::get_if<AckMessage>(&message)) {
    credit_ = std::min(credit_ + ack->bytes, kMaxCredit);
    return {};
  }
  return receive_have(std::get<HaveMessage>(message));
}

Expected<void> StreamState::receive_have(const HaveMessage& have) {
  for (const ChunkRange& range : have.chunks) {
    if (range.last >= manifest_->chunks.size()) {
      return fail(ErrorCode::kBadInput, "have: the model has no such chunk; fetch its head anew");
    }
    for (std::uint64_t i = range.first; i <= range.last; ++i)
      planner_.have(i);
  }
  return {};
}

StreamState::Output StreamState::next() {
  if (!open_want_) return {};
  if (!under_way_) {
    const auto chunk = planner_.next();
    if (!chunk) {
      open_want_ = false;
      return DoneMessage{planner_.bytes_held(), planner_.faces_held()};
    }
    planner_.have(*chunk);
    under_way_ = Slice{.chunk = *chunk};
  }
  return next_slice();
}

StreamState::Output StreamState::next_slice() {
  const auto total = static_cast<std::uint32_t>(manifest_->chunks[under_way_->chunk].length);
  const std::uint32_t most = std::min(kMaxSlice, total - under_way_->offset);
  const auto length = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, credit_));
  if (length == 0) return {};
  credit_ -= length;
  Slice slice = *under_way_;
  slice.length = length;
  under_way_->offset += length;
  if (under_way_->offset == total) under_way_.reset();
  return slice;
}

}  // namespace vitrine
