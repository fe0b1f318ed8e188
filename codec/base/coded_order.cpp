// SPDX-License-Identifier: Apache-2.0
#include "codec/base/coded_order.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFF'FFFFu;

// Base class of both walks: the faces and vertices that a walk has reached so far.
class Walk {
 public:
  explicit Walk(const CornerTable& table) : table_(table), is_done_(table.face_count()) {
    order_.rank.assign(table.vertex_count(), kUnknown);
    order_.corner.reserve(table.vertex_count());
  }

  CodedOrder take() { return std::move(order_); }

 protected:
  bool is_known(Corner c) const { return order_.rank[table_.vertex[c]] != kUnknown; }
  bool is_open(Corner c) const { return c != kNoCorner && !is_done_[c / 3]; }
  void reach(Corner c) {
    if (is_known(c)) return;
    order_.rank[table_.vertex[c]] = static_cast<std::uint32_t>(order_.corner.size());
    order_.corner.push_back(c);
  }
  void finish(Corner c) { is_done_[c / 3] = true; }
  Corner right(Corner c) const { return table_.opposite[next(c)]; }
  Corner left(Corner c) const { return table_.opposite[prev(c)]; }
  bool is_inner(Corner c) const {
    return table_.swing_left(table_.leftmost[table_.vertex[c]]) != kNoCorner;
  }

 private:
  const CornerTable& table_;
  std::vector<bool> is_done_;  // per face: whether the walk has finished it
  CodedOrder order_;
};

class DepthFirstWalk : public Walk {
 public:
  using Walk::Walk;

  void from(Corner start) {
    if (!is_open(start)) return;
    reach(next(start));
    reach(prev(start));
    std::vector<Corner> open = {start};
    while (!open.empty()) {
      const Corner c = open.back();
      open.pop_back();
      if (is_open(c)) follow(c, open);
    }
  }

 private:
  // Walks from face to face until both neighbours of a face are unvisited, or neither is. If both
  // are, appends them to `open`.
  void follow(Corner c, std::vector<Corner>& open) {
    for (;;) {
      finish(c);
      const bool is_new = !is_known(c);
      reach(c);
      const Corner to_right = right(c), to_left = left(c);
      if (is_new && is_inner(c) && to_right != kNoCorner) {
        c = to_right;
      } else if (is_open(to_right) && is_open(to_left)) {
        open.push_back(to_left);
        open.push_back(to_right);
        return;
      } else if (is_open(to_right) || is_open(to_left)) {
        c = is_open(to_right) ? to_right : to_left;
      } else {
        return;
      }
    }
  }
};

class PredictionDegreeWalk : public Walk {
 public:
  explicit PredictionDegreeWalk(const CornerTable& table)
      : Walk(table), table_(table), degree_(table.vertex_count()) {}

  void from(Corner start) {
    if (!is_open(start)) return;
    reach(next(start));
    reach(prev(start));
    reach(start);
    open_[best_ = 0].push_back(start);
    for (Corner c = take_best(); c != kNoCorner; c = take_best()) {
      if (is_open(c)) follow(c);
    }
  }

 private:
  void follow(Corner c) {
    while (c != kNoCorner) {
      finish(c);
      reach(c);
      const Corner to_right = right(c), to_left = left(c);
      const bool has_right = is_open(to_right);
      c = kNoCorner;
      if (is_open(to_left)) c = try_next(to_left, !has_right);
      if (c == kNoCorner && has_right) c = try_next(to_right, true);
    }
  }

  // Returns c if the walk may continue at c immediately. If not, stores c in `open_` for later and
  // returns kNoCorner.
  Corner try_next(Corner c, bool may_continue) {
    const std::size_t priority = priority_of(c);
    if (may_continue && priority <= best_) return c;
    open_[priority].push_back(c);
    best_ = std::min(best_, priority);
    return kNoCorner;
  }

  std::size_t priority_of(Corner c) {
    if (is_known(c)) return 0;
    return ++degree_[table_.vertex[c]] > 1 ? 1 : 2;
  }

  Corner take_best() {
    for (; best_ < open_.size(); ++best_) {
      auto& open = open_[best_];
      if (open.empty()) continue;
      const Corner c = open.back();
      open.pop_back();
      return c;
    }
    return kNoCorner;
  }

  const CornerTable& table_;
  // per vertex: the number of faces from which it was seen
  std::vector<std::uint32_t> degree_;
  std::array<std::vector<Corner>, 3> open_;  // one stack per priority; 0 is visited first
  std::size_t best_ = 0;
};

template <class SomeWalk>
CodedOrder order_of(const CornerTable& table) {
  SomeWalk walk(table);
  for (std::uint32_t f = 0; f < table.face_count(); ++f)
    walk.from(3 * f);
  return walk.take();
}

}  // namespace

CodedOrder depth_first_order(const CornerTable& table) {
  return order_of<DepthFirstWalk>(table);
}

CodedOrder prediction_degree_order(const CornerTable& table) {
  return order_of<PredictionDegreeWalk>(table);
}

}  // namespace vitrine::inline codec
