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
  // Adds an item. Items with equal targets leave the queue one at a time, unless the target is
  // empty: after one was taken, the next one waits for finish().
  void push(const std::string& owner, Item item, const std::string& target = "") {
    Line* const line = target.empty() ? nullptr : &lines_[target];
    std::uint64_t& last = last_round_[owner];
    last = std::max(round_, last + 1);
    items_.emplace(std::pair(last, arrivals_++), Entry{std::move(item), line});
    if (line) ++line->items;
  }

  // Removes and returns the next item, or nullopt if none may leave. Allocates no memory.
  std::optional<Item> take() {
    while (!items_.empty() && is_blocked(items_.begin()->second))
      park_first();
    if (items_.empty()) return std::nullopt;
    const auto first = items_.begin();
    if (first->first.first > round_) begin_round(first->first.first);
    if (first->second.line) first->second.line->is_taken = true;
    std::optional<Item> item = std::move(first->second.item);
    items_.erase(first);
    return item;
  }

  // Lets the next item with this target leave the queue. To be called once for each item with a
  // target that was taken. Allocates no memory.
  void finish(const std::string& target) {
    const auto found = lines_.find(target);
    if (found == lines_.end()) return;
    Line& line = found->second;
    line.is_taken = false;
    if (!line.parked.empty()) items_.insert(line.parked.extract(line.parked.begin()));
    if (--line.items == 0) lines_.erase(found);
  }

  // Number of checks so far whether an item is blocked. Proportional to the number of items,
  // because blocked items are set aside.
  std::uint64_t checks() const { return checks_; }

 private:
  struct Line;
  struct Entry {
    Item item;
    Line* line;  // null if the item has no target
  };
  // The key is the round and the order of arrival.
  using Entries = std::map<std::pair<std::uint64_t, std::uint64_t>, Entry>;
  // The items with the same target.
  struct Line {
    std::size_t items = 0;  // number of items in the queue, and of taken ones before finish()
    bool is_taken = false;  // whether an item was taken for which finish() was not called yet
    // Items that were blocked when take() met them. They are not in `items_`, so that take() need
    // not skip them again. They keep their keys, and finish() returns the first one.
    Entries parked;
  };

  bool is_blocked(const Entry& entry) {
    ++checks_;
    return entry.line && entry.line->is_taken;
  }

  void park_first() {
    Line& line = *items_.begin()->second.line;
    line.parked.insert(items_.extract(items_.begin()));
  }

  // Forgets owners whose last item was in an earlier round; their next items join the new round.
  void begin_round(std::uint64_t round) {
    round_ = round;
    std::erase_if(last_round_, [this](const auto& owner) { return owner.second < round_; });
  }

  Entries items_;
  std::map<std::string, Line> lines_;
  std::map<std::string, std::uint64_t>
      last_round_;  // each owner's last round; erased if it is before `round_`
  std::uint64_t round_ = 1, arrivals_ = 0, checks_ = 0;
};

}  // namespace vitrine::server
