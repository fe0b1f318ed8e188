// SPDX-License-Identifier: Apache-2.0
// Counts requests and bytes, and writes the counts as text for Prometheus [Prometheus]. Labels are
// route templates and classes of status codes. The number of labels is fixed at the start, so
// clients cannot increase it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::server {

// Appends one sample and, if `help` is not empty, its HELP and TYPE lines. `labels` has the form
// `{state="done"}`, or is empty. Samples of one name must follow each other, and only the first may
// have `help`.
void append_metric(std::string& text, std::string_view name, std::string_view labels,
                   std::string_view type, std::string_view help, std::uint64_t value);

// Thread-safe. Each update is one relaxed atomic addition.
class Metrics {
 public:
  // `routes` are the templates of the routes. One more label counts requests that match no route.
  explicit Metrics(std::span<const std::string_view> routes);

  // Counts a request. `route` is an index into `routes`, or routes.size() if no route matched.
  void request(std::size_t route, unsigned status, std::uint64_t bytes, double seconds);

  std::atomic<std::int64_t> connections{0};  // connections open now
  std::atomic<std::int64_t> streams{0};      // WebSocket streams open now
  std::atomic<std::uint64_t> refused{0};  // connections refused because of a limit on connections
  std::atomic<std::uint64_t> stream_bytes{0};    // chunk bytes sent over streams
  std::atomic<std::uint64_t> unknown_tokens{0};  // requests with a token that is unknown or revoked

  // Number of refused requests that are not logged because their addresses had too many of them.
  std::atomic<std::uint64_t> refusals_not_logged{0};
  // The same for responses from memory.
  std::atomic<std::uint64_t> answers_not_logged{0};

  std::string text() const;

 private:
  static constexpr std::array<double, 8> kBounds = {0.0005, 0.001, 0.005, 0.02, 0.1, 0.5, 2.5, 10};
  using Counter = std::atomic<std::uint64_t>;

  struct RouteCounters {
    std::string name;
    std::array<Counter, 5> statuses{};  // requests by status class, 1xx to 5xx
    // Requests by duration in seconds; the last bucket is +Inf.
    std::array<Counter, kBounds.size() + 1> buckets{};
    Counter bytes{0};
    Counter nanoseconds{0};
  };
  void append_requests(std::string& text) const;
  void append_durations(std::string& text) const;

  std::vector<std::unique_ptr<RouteCounters>> routes_;
};

}  // namespace vitrine::server
