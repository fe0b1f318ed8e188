// SPDX-License-Identifier: Apache-2.0
#include "server/stream/model_stream.h"

#include <algorithm>
#include <cmath>

namespace vitrine::server {
namespace {

// How late a chunk may arrive, as a share of the requested seconds.
constexpr double kMostLate = 0.05;
constexpr double kNews = 0.2;  // share by which the rate must change before a new promise is sent
// Share of the remaining time that a promise plans to use. It is below 1, because the link may slow
// down.
constexpr double kCareful = 0.9;
constexpr Pacer::Duration kBetweenPromises{0.2};

Want all_of(const Manifest& manifest) {
  return WantLevel{static_cast<std::uint32_t>(manifest.levels.size() - 1)};
}

}  // namespace

Planner& ModelStream::planner() {
  if (!planner_) planner_.emplace(*manifest_);
  return *planner_;
}

void ModelStream::want(const WantMessage& message, Pacer::Time now) {
  interrupt();
  is_open_ = true;
  turn_ = message.turn;
  timed_.reset();
  if (const auto* want = std::get_if<Want>(&message.target)) {
    planner().want(*want);
  } else {
    const double seconds = std::get<WantSeconds>(message.target).seconds;
    timed_ = Timed{seconds, now + Pacer::Duration(seconds), {}, {}};
    planner().want(all_of(*manifest_));
  }
}

void ModelStream::set_paused(bool is_paused) {
  interrupt();
  is_paused_ = is_paused;
}

// Remembers how much of the current chunk has been sent. Only the remaining bytes are sent later.
void ModelStream::interrupt() {
  if (is_within_chunk()) interrupted_.push_back(*under_way_);
  under_way_.reset();
}

Expected<void> ModelStream::have(const std::vector<ChunkRange>& chunks) {
  if (!chunks.empty() && chunks.back().last >= manifest_->chunks.size()) {
    return fail(ErrorCode::kBadInput, "have: the model has no such chunk; fetch its head again");
  }
  for (const ChunkRange& range : chunks) {
    for (std::uint64_t i = range.first; i <= range.last; ++i)
      planner().have(i);
  }
  if (!is_within_chunk()) under_way_.reset();
  return {};
}

std::uint64_t ModelStream::left_of(std::size_t chunk) const {
  const std::uint64_t length = manifest_->chunks[chunk].length;
  if (under_way_ && under_way_->chunk == chunk) return length - under_way_->offset;
  const auto part = std::ranges::find(interrupted_, chunk, &StartedChunk::chunk);
  return part == interrupted_.end() ? length : length - part->offset;
}

// Whether to send one more chunk. Returns true if all bytes, including this chunk, arrive by the
// deadline. Also returns true if they arrive slightly late (kMostLate), provided that without this
// chunk, the time left until the deadline would be longer than this delay.
bool ModelStream::is_in_time(Ends ends, Pacer::Time now) const {
  const double left = (timed_->deadline - now).count();
  const double late = ends.with - left, early = left - ends.without;
  return late <= 0 || (late < early && late <= kMostLate * timed_->seconds);
}

// Chooses the next chunk and sets under_way_. Returns false if no chunk is left or the next chunk
// would arrive too late.
bool ModelStream::choose(const Share& share, Pacer::Time now) {
  const auto chunk = planner().next();
  if (!chunk) return false;
  if (timed_) {
    const double rate = share.pacer.hope(now);
    if (!is_in_time({share.seconds(0, rate), share.seconds(left_of(*chunk), rate)}, now))
      return false;
  }
  under_way_ = StartedChunk{*chunk, manifest_->chunks[*chunk].length - left_of(*chunk)};
  std::erase_if(interrupted_, [&](const StartedChunk& part) { return part.chunk == *chunk; });
  return true;
}

StreamOutput ModelStream::next(std::uint32_t most, const Share& share, Pacer::Time now) {
  if (is_paused_) return {};
  if (is_open_ && timed_) {
    if (auto promise = news(share, now)) return *promise;
  }
  if (sends_head_) return head_slice(most);
  if (!is_open_) return {};
  if (!under_way_ && !choose(share, now)) {
    // If the link is full or stalled, it may recover in time, so the request stays open.
    if (most == 0 && timed_ && now < timed_->deadline && planner().next()) return {};
    is_open_ = false;
    return DoneMessage{number_, turn_, planner().bytes_held(), planner().faces_held()};
  }
  return chunk_slice(most);
}

StreamOutput ModelStream::head_slice(std::uint32_t most) {
  const std::uint64_t total = manifest_->head_bytes();
  const auto length = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, total - head_sent_));
  if (length == 0) return {};
  const SliceHeader header{.model = number_,
                           .offset = static_cast<std::uint32_t>(head_sent_),
                           .total = static_cast<std::uint32_t>(total)};
  const Slice slice{header, head_sent_, length};
  head_sent_ += length;
  sends_head_ = head_sent_ < total;
  return slice;
}

StreamOutput ModelStream::chunk_slice(std::uint32_t most) {
  const ChunkInfo& chunk = manifest_->chunks[under_way_->chunk];
  const std::uint64_t offset = under_way_->offset;
  const auto length =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(most, chunk.length - offset));
  if (length == 0) {
    if (timed_ && !is_within_chunk())
      under_way_.reset();  // the chunk is chosen again later, because it may then arrive too late
    return {};
  }
  under_way_->offset += length;
  if (under_way_->offset == chunk.length) {
    planner().have(under_way_->chunk);
    under_way_.reset();
  }
  const SliceHeader header{.model = number_,
                           .level = static_cast<std::uint16_t>(chunk.level),
                           .region = chunk.region,
                           .offset = static_cast<std::uint32_t>(offset),
                           .total = static_cast<std::uint32_t>(chunk.length)};
  return Slice{header, chunk.offset + offset, length};
}

// Returns a promise if none has been sent yet, or if the measured rate has changed so much that the
// last promise is outdated. Otherwise returns nullopt.
std::optional<PromiseMessage> ModelStream::news(const Share& share, Pacer::Time now) {
  const auto& last = timed_->promise;
  if (last) {
    const double rate = share.pacer.rate(now) / static_cast<double>(share.sharers);
    const double change = std::abs(rate / last->bytes_per_second - 1);
    const bool is_first_measured = !last->is_measured && share.pacer.is_measured();
    const bool is_settled =
        now - timed_->promised >= kBetweenPromises && !share.pacer.is_falling(now);
    if (!is_first_measured && (change < kNews || !is_settled)) return {};
  }
  PromiseMessage promise = forecast(share, now);
  timed_->promised = now;
  timed_->promise = promise;
  return promise;
}

// Computes the promise for the current rate by simulating next(). Counts no chunk that might arrive
// late.
PromiseMessage ModelStream::forecast(const Share& share, Pacer::Time now) const {
  const double rate = share.pacer.rate(now), left = (timed_->deadline - now).count();
  std::uint64_t bytes = sends_head_ ? manifest_->head_bytes() - head_sent_ : 0;
  Planner then = *planner_;
  auto chunk = under_way_ ? std::optional(under_way_->chunk) : then.next();
  for (; chunk; chunk = then.next()) {
    const std::uint64_t with = bytes + left_of(*chunk);
    const bool is_under_way = under_way_ && under_way_->chunk == *chunk;
    if (!is_under_way && share.seconds(with, rate) > kCareful * left) break;
    then.have(*chunk);
    bytes = with;
  }
  const auto missing = chunk ? manifest_->chunks[*chunk].level
                             : static_cast<std::uint32_t>(manifest_->levels.size());
  return {.model = number_,
          .turn = turn_,
          .level = missing - 1,
          .bytes = then.bytes_held(),
          .triangles = then.faces_held(),
          .error = manifest_->levels[missing - 1].max_error,
          .seconds = share.seconds(bytes, rate),
          .bytes_per_second = rate / static_cast<double>(share.sharers),
          .is_measured = share.pacer.is_measured()};
}

}  // namespace vitrine::server
