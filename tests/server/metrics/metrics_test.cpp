// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;

constexpr std::array<std::string_view, 2> kRoutes = {"/", "/models/{id}"};

TEST(Metrics, CountsRequestsByRouteTemplateAndStatusClass) {
  Metrics metrics(kRoutes);
  metrics.request(1, 200, 100, 0.001);
  metrics.request(1, 304, 0, 0.001);
  metrics.request(7, 404, 10, 0.001);
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("requests_total{route=\"/models/{id}\",status=\"2xx\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("requests_total{route=\"/models/{id}\",status=\"3xx\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("requests_total{route=\"none\",status=\"4xx\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("response_bytes_total{route=\"/models/{id}\"} 100\n"));
}

TEST(Metrics, BucketsOfTheHistogramAreCumulative) {
  Metrics metrics(kRoutes);
  metrics.request(0, 200, 0, 0.001);  // the upper bound of a bucket is inclusive
  metrics.request(0, 200, 0, 0.3);
  metrics.request(0, 200, 0, 100);
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("seconds_bucket{route=\"/\",le=\"0.0005\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("seconds_bucket{route=\"/\",le=\"0.001\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("seconds_bucket{route=\"/\",le=\"0.5\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("seconds_bucket{route=\"/\",le=\"+Inf\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("seconds_count{route=\"/\"} 3\n"));
}

TEST(Metrics, ItsSizeDoesNotDependOnTheRequests) {
  Metrics metrics(kRoutes);
  const auto lines = [&] {
    const std::string text = metrics.text();
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto before = lines();
  for (unsigned status = 0; status < 1000; ++status)
    metrics.request(status, status, 1, status);
  EXPECT_EQ(lines(), before);
}

}  // namespace
}  // namespace vitrine::server
