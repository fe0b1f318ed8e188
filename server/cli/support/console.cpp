// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "server/metadata/text.h"

namespace vitrine::server::cli {

namespace {

// Returns the outcome of a write to stdout or stderr. Call this before errno changes.
CommandOutcome outcome_of(bool is_written) {
  if (is_written) return {};
  if (errno == EPIPE) return tl::unexpected(Fault{kNobodyReads, {}});
  return failed(fmt::format("cannot write the result to stdout: {}; check its destination",
                            std::strerror(errno)));
}

}  // namespace

CommandOutcome print(std::string_view text, std::FILE* stream) {
  return outcome_of(std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
                    std::fputc('\n', stream) != EOF && std::fflush(stream) == 0);
}

CommandOutcome print_json(const nlohmann::json& object, std::FILE* stream) {
  return print(object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), stream);
}

CommandOutcome print_bytes(std::span<const std::uint8_t> bytes) {
  return outcome_of(std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() &&
                    std::fflush(stdout) == 0);
}

void print_fault(std::string_view message) {
  // Escapes line breaks and invalid UTF-8, which names of files may contain.
  const std::string line = fmt::format("vitrine: {}\n", as_plain_text(message));
  std::fwrite(line.data(), 1, line.size(), stderr);  // fmt::print would throw if the disk is full
}

void print_note(std::string_view message) {
  print_fault(fmt::format("note: {}", message));
}

std::string time_left(double seconds, double fraction, double since) {
  constexpr double kSomething = 0.02;
  if (!(fraction >= kSomething && fraction < 1)) return {};
  const double left = std::max(seconds * (1 - fraction) / fraction - since, 0.5);
  const auto [unit, length] = left < 100        ? std::pair("s", 1)
                              : left < 100 * 60 ? std::pair("min", 60)
                                                : std::pair("h", 3600);
  return fmt::format("about {:.0f} {} left", std::ceil(left / length), unit);
}

ProgressBar::ProgressBar() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (ticker_.joinable()) ticker_.request_stop(), ticker_.join();
  if (is_terminal_) std::fputs("\r\x1b[K", stderr);
}

ProgressReport ProgressBar::report() {
  return [this](std::string_view stage, double fraction) { show(stage, fraction); };
}

void ProgressBar::show(std::string_view stage, double fraction) {
  if (!is_terminal_) return;
  const std::lock_guard lock(mutex_);
  // escapes control characters, because the text may come from a server
  stage_ = as_plain_text(stage);
  share_ = fraction >= 0 && fraction <= 1 ? fraction : 0;
  shown_ = Clock::now();
  draw();
  if (!ticker_.joinable())
    ticker_ = std::jthread([this](const std::stop_token& stop) { keep_drawing(stop); });
}

void ProgressBar::draw() const {
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(share_ * kWidth);
  const std::chrono::duration<double> took = shown_ - start_, since = Clock::now() - shown_;
  const std::string line =
      fmt::format("\r\x1b[K[{:#<{}}{:.<{}}] {:3.0f} % {}  {}", "", filled, "", kWidth - filled,
                  100 * share_, stage_, time_left(took.count(), share_, since.count()));
  // Uses fwrite, because fmt::print would throw if the terminal has been closed.
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
}

void ProgressBar::keep_drawing(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, stop, std::chrono::seconds(1),
                            [&] { return stop.stop_requested(); }))
    draw();
}

}  // namespace vitrine::server::cli
