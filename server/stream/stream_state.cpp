// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_state.h"

#include <algorithm>

namespace vitrine::server {
namespace {

constexpr Pacer::Duration kPoll{0.02};  // interval at which the kernel's send queue is checked
// Seconds between checks whether a `seconds` request needs a new promise.
constexpr Pacer::Duration kPromiseInterval{0.1};

}  // namespace

StreamState::Sharer* StreamState::find(std::uint16_t model) {
  const auto found =
      std::ranges::find(models_, model, [](const Sharer& m) { return m.stream.number(); });
  return found == models_.end() ? nullptr : &*found;
}

Expected<void> StreamState::open(std::uint16_t model, const Manifest& manifest, bool sends_head) {
  if (find(model) != nullptr) return fail(ErrorCode::kBadInput, "open: the number is taken");
  const std::uint64_t served = models_.empty() ? 0 : models_.front().served;
  models_.insert(models_.begin(), Sharer{ModelStream(model, manifest, sends_head), served});
  return {};
}

Expected<void> StreamState::receive(const ClientMessage& message, Time now) {
  return std::visit([&](const auto& one) { return receive_one(one, now); }, message);
}

template <class Do>
Expected<void> StreamState::with_model(std::uint16_t number, const Do& act) {
  Sharer* const model = find(number);
  if (model == nullptr) return fail(ErrorCode::kBadInput, "no model is open under this number");
  return act(model->stream);
}

Expected<void> StreamState::receive_one(const OpenMessage&, Time) {
  return fail(ErrorCode::kState, "an open message is for StreamState::open()");
}

Expected<void> StreamState::receive_one(const CloseMessage& message, Time) {
  std::erase_if(models_, [&](const Sharer& m) { return m.stream.number() == message.model; });
  return {};
}

Expected<void> StreamState::receive_one(const WantMessage& message, Time now) {
  return with_model(message.model, [&](ModelStream& model) -> Expected<void> {
    model.want(message, now);
    return {};
  });
}

Expected<void> StreamState::receive_one(const HaveMessage& message, Time) {
  return with_model(message.model, [&](ModelStream& model) { return model.have(message.chunks); });
}

Expected<void> StreamState::receive_one(const PauseMessage& message, Time) {
  return with_model(message.model, [&](ModelStream& model) -> Expected<void> {
    model.set_paused(message.is_pause);
    return {};
  });
}

Expected<void> StreamState::receive_one(const AckMessage& message, Time now) {
  credit_ = std::min(credit_ + message.bytes, kMaxCredit);
  if (!is_granted_ahead()) pacer_.arrived(message.bytes, now);
  granted_ += message.bytes;
  return {};
}

void StreamState::still_queued(std::uint64_t bytes, Time now) {
  if (bytes < pacer_.in_flight()) pacer_.arrived(pacer_.in_flight() - bytes, now);
}

// Returns the largest size of the next slice, or 0 if no slice may be sent.
std::uint32_t StreamState::room(Time now, std::size_t busy_streams) {
  const std::uint32_t paced = pacer_.room(now, busy_streams);
  is_held_ = credit_ > 0 && paced == 0;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(paced, credit_));
}

StreamOutput StreamState::next(Time now, std::size_t busy_streams) {
  const std::uint32_t most = room(now, busy_streams);
  const auto is_sending = [](const Sharer& model) { return model.stream.is_sending(); };
  const auto sharers = static_cast<std::size_t>(std::ranges::count_if(models_, is_sending));
  for (Sharer& model : models_) {
    const StreamOutput output = model.stream.next(most, {pacer_, sharers}, now);
    if (std::holds_alternative<std::monostate>(output)) continue;
    if (const auto* slice = std::get_if<Slice>(&output)) serve(model, slice->length, now);
    return output;
  }
  return {};
}

// Counts `bytes` as sent for `model`. Raises the counts of models with nothing to send to the count
// of `model`, so that they cannot make up for their idle time later.
void StreamState::serve(Sharer& model, std::uint32_t bytes, Time now) {
  credit_ -= bytes;
  sent_ += bytes;
  pacer_.sent(bytes, now);
  model.served += bytes;
  const std::uint64_t served = model.served;
  for (Sharer& other : models_) {
    if (!other.stream.is_sending()) other.served = std::max(other.served, served);
  }
  std::ranges::stable_sort(models_, {}, &Sharer::served);
}

std::optional<StreamState::Time> StreamState::wakes(Time now) const {
  const bool is_timed =
      std::ranges::any_of(models_, [](const Sharer& model) { return model.stream.is_timed(); });
  if (pacer_.in_flight() == 0 && !is_timed) return std::nullopt;
  if (is_granted_ahead() && pacer_.in_flight() > 0) return now + kPoll;
  if (is_timed) return now + kPromiseInterval;
  if (is_held_) return now + Pacer::kNudge;
  return std::nullopt;
}

}  // namespace vitrine::server
