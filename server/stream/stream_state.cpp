// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_state.h"

#include <algorithm>

namespace vitrine {
namespace {

constexpr Pacer::Duration kPoll{0.02};         // of the kernel's queue
constexpr Pacer::Duration kNewsInterval{0.1};  // promises are looked at

}  // namespace

ModelStream* StreamState::find(std::uint16_t model) {
  const auto found = std::ranges::find(models_, model, &ModelStream::number);
  return found == models_.end() ? nullptr : &*found;
}

Expected<void> StreamState::open(std::uint16_t model, const Manifest& manifest, bool head) {
  if (find(model) != nullptr) return fail(ErrorCode::kBadInput, "open: the number is taken");
  models_.emplace_back(model, manifest, head);
  return {};
}

Expected<void> StreamState::receive(const ClientMessage& message, Time now) {
  return std::visit([&](const auto& one) { return receive_one(one, now); }, message);
}

template <class Do>
Expected<void> StreamState::with_model(std::uint16_t number, const Do& act) {
  ModelStream* const model = find(number);
  if (model == nullptr) return fail(ErrorCode::kBadInput, "no model is open under this number");
  return act(*model);
}

Expected<void> StreamState::receive_one(const OpenMessage&, Time) {
  return fail(ErrorCode::kState, "open is the caller's to answer");
}

Expected<void> StreamState::receive_one(const CloseMessage& message, Time) {
  std::erase_if(models_, [&](const ModelStream& m) { return m.number() == message.model; });
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
    model.pause(message.pause);
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

// How long the next slice may be; 0 where none may go.
std::uint32_t StreamState::room(Time now) {
  is_held_ = credit_ > 0 && !pacer_.may_send(now);
  return is_held_ ? 0
                  : static_cast<std::uint32_t>(
                        std::min<std::uint64_t>(pacer_.slice_bytes(now), credit_));
}

StreamOutput StreamState::next(Time now) {
  const std::uint32_t most = room(now);
  for (std::size_t turn = 0; turn < models_.size(); ++turn) {
    ModelStream& model = models_.front();
    const StreamOutput output = model.next(most, pacer_, now);
    if (const auto* slice = std::get_if<Slice>(&output)) {
      credit_ -= slice->length;
      sent_ += slice->length;
      pacer_.sent(slice->length, now);
    }
    if (!model.is_within_chunk()) std::rotate(models_.begin(), models_.begin() + 1, models_.end());
    if (!std::holds_alternative<std::monostate>(output)) return output;
  }
  return {};
}

std::optional<StreamState::Time> StreamState::wakes(Time now) const {
  if (pacer_.in_flight() == 0) return std::nullopt;
  if (is_granted_ahead()) return now + kPoll;
  if (std::ranges::any_of(models_, &ModelStream::is_timed)) return now + kNewsInterval;
  if (is_held_) return now + Pacer::kNudge;
  return std::nullopt;
}

}  // namespace vitrine
