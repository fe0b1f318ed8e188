// SPDX-License-Identifier: Apache-2.0
#include "server/app/poster_queue.h"

#include <fmt/core.h>

#include <exception>
#include <memory>
#include <utility>

namespace vitrine::server {

void PosterQueue::add(const Order& order) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(order);
    if (std::exchange(is_busy_, true)) return;
  }
  start_next();
}

void PosterQueue::start_next() {
  std::optional<Order> next;
  {
    const std::scoped_lock lock(mutex_);
    is_busy_ = !waiting_.empty();
    if (!is_busy_) return;
    next = waiting_.front();
    waiting_.pop_front();
  }
  try {
    workers_.compute(io_, "posters", next->model.to_string(), [this, order = *next] {
      carry_out(order);
      start_next();
    });
  } catch (const std::exception&) {  // std::bad_alloc; the next add() continues
    const std::scoped_lock lock(mutex_);
    is_busy_ = false;
    waiting_.push_front(*next);
  }
}

void PosterQueue::carry_out(const Order& order) {
  try {
    const auto fault = try_to_make(order.model);
    if (fault) repeat_later({order.model, order.attempts + 1}, *fault);
  } catch (const std::exception& lost) {  // std::bad_alloc; the next model follows
    events_.event(Severity::kError, lost.what());
  }
}

std::optional<std::string> PosterQueue::try_to_make(const ModelId& model) {
  try {
    const auto made = make_(model);
    return made ? std::nullopt : std::optional(made.error().message);
  } catch (const std::exception& fault) {
    return fault.what();
  }
}

void PosterQueue::repeat_later(Order order, const std::string& fault) {
  if (order.attempts == kMostAttempts) {
    return events_.event(Severity::kWarning,
                         fmt::format("{} attempts to make the posters of model {} have failed; a "
                                     "request for a poster tries again: {}",
                                     kMostAttempts, order.model.to_string(), fault));
  }
  const auto timer = std::make_shared<asio::steady_timer>(io_, pause_);
  timer->async_wait([this, timer, order](const boost::system::error_code& error) {
    if (!error) add(order);
  });
}

}  // namespace vitrine::server
