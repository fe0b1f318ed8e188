// SPDX-License-Identifier: Apache-2.0
#include "server/stream/pacer.h"

#include <algorithm>

#include "server/stream/slice.h"

namespace vitrine::server {

Pacer::Duration Pacer::busy(Time now) const {
  return in_flight() > 0 ? busy_ + (now - then_) : busy_;
}

void Pacer::advance(Time now) {
  busy_ = busy(now);
  then_ = now;
}

void Pacer::sent(std::uint64_t bytes, Time now) {
  advance(now);
  if (samples_.empty()) samples_.push_back({busy_, arrived_});
  progress_ = now;
  if (in_flight() == 0) heard_ = now;
  sent_ += bytes;
  if (marks_.size() < kMostMarks) marks_.push_back({sent_, now});
}

// Returns the time from the sending of the newest acknowledged slice until now, and updates base_.
// Returns a negative value if no other slice has arrived since the last call, or if base_ is about
// to be measured again.
Pacer::Duration Pacer::measure_delay(Time now) {
  const auto open = std::ranges::find_if(marks_, [&](const Mark& m) { return m.end > arrived_; });
  if (open == marks_.begin()) return Duration{-1};
  const Duration delay = now - std::prev(open)->at;
  marks_.erase(marks_.begin(), open);
  if (drains_) return Duration{-1};
  if (base_ == Duration::max()) base_since_ = now;
  base_ = std::min(base_, delay);
  if (now - base_since_ > kBaseAge) {
    base_ = Duration::max();
    drains_ = true;
  }
  return delay;
}

void Pacer::add_sample() {
  if (samples_.size() > 1 && samples_.back().busy - samples_[samples_.size() - 2].busy < kSample) {
    samples_.back() = {busy_, arrived_};
  } else {
    samples_.push_back({busy_, arrived_});
  }
  while (samples_.size() > 2 && busy_ - samples_[1].busy >= kWindow)
    samples_.erase(samples_.begin());
}

void Pacer::arrived(std::uint64_t bytes, Time now) {
  advance(now);
  bytes = std::min(bytes, in_flight());
  if (bytes == 0) return;
  arrived_ += bytes;
  progress_ = now;
  add_sample();
  is_measured_ = is_measured_ || samples_.back().busy - samples_.front().busy >= kLeastTime ||
                 arrived_ >= kEnough;
  note_silence(now);
  const Duration delay = measure_delay(now);
  if (delay.count() < 0 || base_ == Duration::max()) return;
  const double speed = rate(now), fitting = speed * base_.count() + queue_bytes(speed);
  const double more = delay - base_ < kShortQueue ? window_ + static_cast<double>(bytes) : 0;
  window_ = std::clamp(std::max(fitting, more), kLeastWindow, kMostWindow);
}

// Updates steady_, the rate while the link does not stall, after bytes have arrived. Repeated
// stalls lower this rate, because they show that the link has become slow.
void Pacer::note_silence(Time now) {
  const bool was_silent = now - heard_ >= kNudge;
  if (was_silent) recovered_ = busy_;
  heard_ = now;
  if (!is_measured_) return;
  if (was_silent) steady_ = std::max(rate(now), steady_ / 2);
  if (busy_ - recovered_ >= kWindow) steady_ = rate(now);
}

// Returns the number of bytes that may queue at this rate. This number grows with the rate, but
// more slowly than the rate. If connections share a queue, the fast connections therefore slow down
// and the slow ones speed up until all have the same rate.
double Pacer::queue_bytes(double rate) {
  const double extra = std::min(rate * (kQueue - kFastQueue).count(), kFastExtra);
  return std::max(rate * kFastQueue.count() + extra, kLeastWindow);
}

std::uint32_t Pacer::slice_bytes(double rate) const {
  constexpr double kLeast = 1024;
  return static_cast<std::uint32_t>(
      std::clamp(rate * slice_time_.count(), kLeast, static_cast<double>(kMaxSlice)));
}

// A measured delay contains the link's own delay and the queues of other senders, and a connection
// cannot distinguish the two. Therefore also limits the bytes in flight beyond those that the
// connection's own delay and queue require. All connections share that limit (kShared).
std::uint32_t Pacer::room(Time now, std::size_t busy_streams) {
  const double speed = rate(now), sharers = std::max(1.0, static_cast<double>(busy_streams));
  slice_time_ = std::max(kSliceTime, sharers * kSliceCost);
  const std::uint32_t slice = slice_bytes(speed);
  if (in_flight() == 0) drains_ = false;
  if (in_flight() == 0 || now - progress_ >= kNudge) return slice;
  const double own = speed * own_.value_or(Duration::zero()).count();
  const double shared = (own_ ? kShared : kUnknownShared) / sharers;
  const double most = std::min(window_, own + queue_bytes(speed) + shared);
  const double left = most - static_cast<double>(in_flight());
  if (drains_ || left < slice / 2.0) return 0;
  return std::min(slice, static_cast<std::uint32_t>(left));
}

double Pacer::rate(Time now) const {
  if (!is_measured_) return kFirstGuess;
  const Duration until = busy(now);
  const Sample *first = &samples_.front(), *last = &samples_.back();
  for (const Sample& sample : samples_) {
    if (until - sample.busy >= kWindow) first = &sample;
  }
  const auto arrived = static_cast<double>(last->arrived - first->arrived);
  const auto next = static_cast<double>(std::min<std::uint64_t>(in_flight(), kMaxSlice));
  const double seen = arrived / std::max(last->busy - first->busy, kLeastTime).count();
  // The rate that results if the next slice arrives now.
  const double possible = (arrived + next) / std::max(until - first->busy, kLeastTime).count();
  if (first == last) return std::max(1.0, possible);
  return std::max(1.0, next > 0 ? std::min(seen, possible) : seen);
}

bool Pacer::is_falling(Time now) const {
  constexpr double kMuch = 0.9;
  if (!is_measured_) return false;
  if (in_flight() > 0 && now - heard_ >= 2 * slice_time_) return true;
  const Sample& last = samples_.back();
  const auto before = std::find_if(samples_.rbegin(), samples_.rend(), [&](const Sample& sample) {
    return last.busy - sample.busy >= kLeastTime;
  });
  if (before == samples_.rend()) return false;
  const auto arrived = static_cast<double>(last.arrived - before->arrived);
  return arrived / (last.busy - before->busy).count() < kMuch * rate(now);
}

double Pacer::hope(Time now) const {
  constexpr Duration kSomething{0.05};
  if (is_measured_) {
    const bool is_silent = in_flight() > 0 && now - heard_ >= kNudge;
    const bool recovers = busy(now) - recovered_ < kWindow;
    return is_silent || recovers ? std::max(rate(now), steady_) : rate(now);
  }
  const double seen = static_cast<double>(arrived_) / std::max(busy(now), kSomething).count();
  return busy(now) < kSomething ? std::max(4 * kFirstGuess, seen) : std::max(kFirstGuess, seen);
}

}  // namespace vitrine::server
