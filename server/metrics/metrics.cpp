// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/metrics.h"

#include <fmt/format.h>

#include <algorithm>

namespace vitrine::server {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

template <class Value>
void append_plain(std::string& text, std::string_view name, std::string_view type,
                  std::string_view help, Value value) {
  text += fmt::format("# HELP {0} {2}\n# TYPE {0} {1}\n{0} {3}\n", name, type, help, value);
}

}  // namespace

void append_metric(std::string& text, std::string_view name, std::string_view labels,
                   std::string_view type, std::string_view help, std::uint64_t value) {
  if (!help.empty()) text += fmt::format("# HELP {0} {2}\n# TYPE {0} {1}\n", name, type, help);
  text += fmt::format("{}{} {}\n", name, labels, value);
}

Metrics::Metrics(std::span<const std::string_view> routes) {
  for (const std::string_view name : routes) {
    routes_.push_back(std::make_unique<RouteCounters>());
    routes_.back()->name = name;
  }
  routes_.push_back(std::make_unique<RouteCounters>());
  routes_.back()->name = "none";
}

void Metrics::request(std::size_t route, unsigned status, std::uint64_t bytes, double seconds) {
  RouteCounters& at = *routes_[std::min(route, routes_.size() - 1)];
  const std::size_t status_class = std::clamp(status / 100, 1u, 5u) - 1;
  const auto bucket = std::ranges::lower_bound(kBounds, seconds) - kBounds.begin();
  at.statuses[status_class].fetch_add(1, kRelaxed);
  at.buckets[static_cast<std::size_t>(bucket)].fetch_add(1, kRelaxed);
  at.bytes.fetch_add(bytes, kRelaxed);
  at.nanoseconds.fetch_add(static_cast<std::uint64_t>(seconds * 1e9), kRelaxed);
}

std::string Metrics::text() const {
  std::string text;
  append_requests(text);
  append_durations(text);
  append_plain(text, "vitrine_connections", "gauge", "Connections open now.",
               connections.load(kRelaxed));
  append_plain(text, "vitrine_streams", "gauge", "WebSocket streams open now.",
               streams.load(kRelaxed));
  append_plain(text, "vitrine_connections_refused_total", "counter",
               "Connections closed because the limit was reached.", refused.load(kRelaxed));
  append_plain(text, "vitrine_stream_bytes_total", "counter", "Chunk bytes sent over streams.",
               stream_bytes.load(kRelaxed));
  append_plain(text, "vitrine_unknown_tokens_total", "counter",
               "Requests with a token that is unknown or revoked.", unknown_tokens.load(kRelaxed));
  append_plain(text, "vitrine_refusals_not_logged_total", "counter",
               "Refused requests that the logs leave out, since their address had many.",
               refusals_not_logged.load(kRelaxed));
  append_plain(text, "vitrine_answers_not_logged_total", "counter",
               "Responses from memory that the log leaves out, since their address had many.",
               answers_not_logged.load(kRelaxed));
  return text;
}

void Metrics::append_requests(std::string& text) const {
  text +=
      "# HELP vitrine_http_requests_total Requests answered.\n"
      "# TYPE vitrine_http_requests_total counter\n";
  for (const auto& route : routes_) {
    for (std::size_t i = 0; i < route->statuses.size(); ++i) {
      text += fmt::format("vitrine_http_requests_total{{route=\"{}\",status=\"{}xx\"}} {}\n",
                          route->name, i + 1, route->statuses[i].load(kRelaxed));
    }
  }
  text +=
      "# HELP vitrine_http_response_bytes_total Body bytes sent.\n"
      "# TYPE vitrine_http_response_bytes_total counter\n";
  for (const auto& route : routes_) {
    text += fmt::format("vitrine_http_response_bytes_total{{route=\"{}\"}} {}\n", route->name,
                        route->bytes.load(kRelaxed));
  }
}

void Metrics::append_durations(std::string& text) const {
  constexpr std::string_view kName = "vitrine_http_request_seconds";
  text += fmt::format(
      "# HELP {0} Time from a request's header to the last byte of the response.\n# TYPE {0} "
      "histogram\n",
      kName);
  for (const auto& route : routes_) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < kBounds.size(); ++i) {
      count += route->buckets[i].load(kRelaxed);
      text += fmt::format("{}_bucket{{route=\"{}\",le=\"{}\"}} {}\n", kName, route->name,
                          kBounds[i], count);
    }
    count += route->buckets.back().load(kRelaxed);
    text += fmt::format("{}_bucket{{route=\"{}\",le=\"+Inf\"}} {}\n", kName, route->name, count);
    text += fmt::format("{}_sum{{route=\"{}\"}} {}\n", kName, route->name,
                        static_cast<double>(route->nanoseconds.load(kRelaxed)) * 1e-9);
    text += fmt::format("{}_count{{route=\"{}\"}} {}\n", kName, route->name, count);
  }
}

}  // namespace vitrine::server
