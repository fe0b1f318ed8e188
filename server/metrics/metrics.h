// SPDX-License-Identifier: Apache-2.0
// What is counted, and its text for Prometheus (exposition format 0.0.4). The labels are route
// templates and classes of status codes: their number is fixed when the daemon starts, whatever
// visitors ask for.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine {

// One sample with its HELP and TYPE lines. `labels`: `{state="done"}`, or empty; those of one name
// follow each other, and the first alone has `help`.
void append_metric(std::string& text, std::string_view name, std::string_view labels,
                   std::string_view type, std::string_view help, std::uint64_t value);

// Every update is one relaxed atomic addition; thread-safe.
class Metrics {
 public:
  // The templates of the routes; one more is added for requests that match none.
  explicit Metrics(std::span<const std::string_view> routes);

  // `route` is an index into `routes`, or routes.size() where none matched.
  void request(std::size_t route, unsigned status, std::uint64_t bytes, double seconds);

  std::atomic<std::int64_t> connections{0};      // open now
  std::atomic<std::int64_t> streams{0};          // WebSocket streams open now
  std::atomic<std::uint64_t> refused{0};         // connections closed by max-connections
  std::atomic<std::uint64_t> stream_bytes{0};    // chunk bytes sent over streams
  std::atomic<std::uint64_t> unknown_tokens{0};  // presented and nobody's

  std::string text() const;

 private:
  static constexpr std::array<double, 8> kBounds = {0.0005, 0.001, 0.005, 0.02, 0.1, 0.5, 2.5, 10};
  using Counter = std::atomic<std::uint64_t>;

  struct Route {
    std::string name;
    std::array<Counter, 5> statuses{};                  // 1xx to 5xx
    std::array<Counter, kBounds.size() + 1> buckets{};  // by duration; the last is +Inf
    Counter bytes{0};
    Counter nanoseconds{0};
  };
  void append_requests(std::string& text) const;
  void append_durations(std::string& text) const;

  std::vector<std::unique_ptr<Route>> routes_;
};

}  // namespace vitrine
