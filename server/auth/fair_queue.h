// SPDX-License-Identifier: Apache-2.0
// A queue that serves its owners in turn. Even an owner with many items delays each item of another
// owner by at most one item.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace vitrine::server {

// Each owner has at most one item in a round. The queue serves the rounds one after the other, and
// the items of a round in order of arrival. Not thread-safe.
template <class Item>
class FairQueue {
 public:
  void push(const std::string& owner, Item item) {
    std::uint64_t& last = last_round_[owner];
    last = std::max(round_, last + 1);
    items_.emplace(std::pair(last, arrivals_++), std::move(item));
  }

  // Removes and returns the next item for which `is_ready(item)` is true, or nullopt.
  template <class Predicate>
  std::optional<Item> take(Predicate is_ready) {
    const auto next =
        std::ranges::find_if(items_, [&](const auto& entry) { return is_ready(entry.second); });
    if (next == items_.end()) return std::nullopt;
    if (next->first.first > round_) begin_round(next->first.first);
    std::optional<Item> item = std::move(next->second);
    items_.erase(next);
    return item;
  }

 private:
  // Forgets owners whose last item was in an earlier round; their next items join the new round.
  void begin_round(std::uint64_t round) {
    round_ = round;
    std::erase_if(last_round_, [this](const auto& owner) { return owner.second < round_; });
  }

  // The key is the round and the order of arrival.
  std::map<std::pair<std::uint64_t, std::uint64_t>, Item> items_;
  std::map<std::string, std::uint64_t>
      last_round_;  // each owner's last round; erased if it is before `round_`
  std::uint64_t round_ = 1, arrivals_ = 0;
};

}  // namespace vitrine::server
