// SPDX-License-Identifier: Apache-2.0
// Prints results to stdout, and progress and errors to stderr.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "server/cli/support/outcome.h"
#include "server/sandbox/sandbox.h"

namespace vitrine::server::cli {

// Writes `text` and a line break to `stream`. Fails if they cannot be written, for example on a
// full disk. If the reader has closed the pipe, the failure has no message.
CommandOutcome print(std::string_view text, std::FILE* stream = stdout);
// Prints the object as JSON. Replaces bytes that are not UTF-8.
CommandOutcome print_json(const nlohmann::json& object, std::FILE* stream = stdout);

// Writes the content of a file to stdout. Fails like print().
CommandOutcome print_bytes(std::span<const std::uint8_t> bytes);

// Prints "vitrine: " and the message to stderr, as one line of plain text (as_plain_text()).
// Ignores errors of stderr.
void print_fault(std::string_view message);
// Prints a message that is not an error to stderr: "vitrine: note: " and the message.
void print_note(std::string_view message);

// Returns the estimated time left, such as "about 40 s left". The share `fraction` (0..1) of the
// work took `seconds`; `since` seconds have passed since `fraction` was measured. Returns an empty
// text if there is no estimate yet or no work is left.
std::string time_left(double seconds, double fraction, double since);

// A progress bar with the estimated time left. It is drawn on stderr, but only if stderr is a
// terminal. The destructor removes the bar. After the first report, a separate thread keeps the
// time up to date.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  ProgressReport report();  // the result is valid while the bar exists

 private:
  using Clock = std::chrono::steady_clock;

  void show(std::string_view stage, double fraction);
  void draw() const;
  void keep_drawing(const std::stop_token& stop);

  const bool is_terminal_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;  // guards the members below
  std::condition_variable_any stopped_;
  std::string stage_;
  double share_ = 0;
  Clock::time_point shown_;
  std::jthread ticker_;
};

}  // namespace vitrine::server::cli
