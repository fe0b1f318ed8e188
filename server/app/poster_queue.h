// SPDX-License-Identifier: Apache-2.0
// Makes posters in the background, for one model at a time, so that most threads stay free for
// visitors' exports.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "server/catalogue/id.h"
#include "server/http/workers.h"
#include "server/log/log.h"

namespace vitrine::server {

// Thread-safe.
class PosterQueue {
 public:
  // Makes the posters of a model. May throw, for example std::bad_alloc.
  using Make = std::function<Expected<void>(const ModelId& model)>;

  // If the posters of a model cannot be made, tries again twice, each time after `pause`. All
  // references must outlive the queue, and `io` must not run when the queue is destroyed.
  PosterQueue(Workers& workers, asio::io_context& io, const Log& events, Make make,
              std::chrono::milliseconds pause = std::chrono::minutes(1))
      : workers_(workers), io_(io), events_(events), make_(std::move(make)), pause_(pause) {}

  // Queues a model, whose posters are made after those of the models queued before it. Returns at
  // once.
  void add(const ModelId& model) { add(Order{model}); }

 private:
  static constexpr int kMostAttempts = 3;

  struct Order {
    ModelId model;
    int attempts = 0;  // number of attempts that have failed
  };

  void add(const Order& order);
  void start_next();
  void carry_out(const Order& order);
  // Returns the fault, or nullopt if the posters were made.
  std::optional<std::string> try_to_make(const ModelId& model);
  // Adds the order again after the pause. After the last attempt, only logs the fault.
  void repeat_later(Order order, const std::string& fault);

  Workers& workers_;
  asio::io_context& io_;
  const Log& events_;
  const Make make_;
  const std::chrono::milliseconds pause_;
  std::mutex mutex_;  // guards the members below
  bool is_busy_ = false;
  std::deque<Order> waiting_;
};

}  // namespace vitrine::server
