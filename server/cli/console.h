// SPDX-License-Identifier: Apache-2.0
// Results go to stdout, progress and faults to stderr.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "server/cli/outcome.h"
#include "server/jobs/sandbox.h"

namespace vitrine::cli {

// Writes `text` and a line end to stdout. Fails where it cannot take them (a full disk),
// in silence where nobody reads it any more.
Outcome print(std::string_view text);
Outcome print_json(const nlohmann::json& object);  // what is not UTF-8 in it is replaced

// Prints "vitrine: …" to stderr, where that takes it.
void print_fault(std::string_view message);
void print_note(std::string_view message);  // "vitrine: note: …": worth knowing, and no fault

// How long the rest of a work takes of which `fraction` (0..1) took `seconds`, where `since` more
// seconds have gone since then, in words: "about 40 s left". Empty where that cannot be told yet,
// or nothing is left.
std::string time_left(double seconds, double fraction, double since);

// A bar with the time left on stderr where that is a terminal, else nothing. Gone when destroyed.
// The time left runs down on a thread of its own from the first report on.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  ProgressReport report();  // valid as long as the bar

 private:
  using Clock = std::chrono::steady_clock;

  void show(std::string_view stage, double fraction);
  void draw() const;
  void keep_drawing(const std::stop_token& stop);

  const bool is_terminal_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;  // of what follows
  std::condition_variable_any stopped_;
  std::string stage_;
  double share_ = 0;
  Clock::time_point shown_;
  std::jthread ticker_;
};

}  // namespace vitrine::cli
