// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scan_order.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace vitrine {
namespace {

using Json = nlohmann::json;

// The field that is at fault, the only one.
std::string fault_in(const Json& body) {
  const auto order = parse_scan_order(body);
  if (order || order.error().size() != 1) return "";
  return order.error().front().field;
}

TEST(ScanOrder, a_scanner_is_enough) {
  const auto order = parse_scan_order({{"scanner", "rig"}});
  ASSERT_TRUE(order);
  EXPECT_EQ(order->steps, 720);
  EXPECT_EQ(order->length, 10);
  EXPECT_EQ(order->sampling, Sampling::kAdaptive);
  EXPECT_FALSE(order->publish);
}

TEST(ScanOrder, what_was_ordered_is_read_back_from_its_text) {
  const Json body = {
      {"scanner", "rig"},
      {"steps", 90},
      {"exposure", 2500.5},
      {"keep_frames", true},
      {"sampling", "paper"},
      {"length", 15},
      {"bits", 14},
      {"placement", "pyramid"},
      {"publish", true},
      {"metadata", {{"title", "T"}, {"creator", "C"}, {"rights", "R"}, {"licence", "CC0-1.0"}}}};
  const auto order = parse_scan_order(body);
  ASSERT_TRUE(order);
  EXPECT_EQ(Json::parse(to_json_text(*order)), body);
}

TEST(ScanOrder, each_fault_names_its_field) {
  const Json good = {{"scanner", "rig"}};
  const std::pair<const char*, std::vector<Json>> wrong[] = {
      {"scanner", {1, "two\nlines"}},
      {"steps", {7, 36'001, 12.5, "720", nullptr, 1e300}},
      {"exposure", {0, -1, 1e9, "fast"}},
      {"sampling", {"random", 1}},
      {"length", {0, 1, 6, 25, 10.0, "ten"}},
      {"bits", {9, 17, 12.5, "many"}},
      {"placement", {"anywhere", 2}},
      {"keep_frames", {1, "yes"}},
      {"publish", {0, "no"}},
      {"metadata", {1, "title"}},
      {"colour", {"red"}}};
  for (const auto& [field, values] : wrong) {
    for (const Json& value : values) {
      Json body = good;
      body[field] = value;
      EXPECT_EQ(fault_in(body), field) << value;
    }
  }
  EXPECT_EQ(fault_in(Json::object()), "scanner");
  EXPECT_EQ(fault_in({{"scanner", "rig"}, {"metadata", {{"title", 1}}}}), "metadata.title");
  EXPECT_EQ(fault_in({{"scanner", "rig"}, {"metadata", {{"date", "1"}}}}), "metadata.date");
}

TEST(ScanOrder, all_faults_are_told_at_once) {
  const auto order = parse_scan_order({{"steps", 0}, {"bits", 1}});
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().size(), 3u);
}

TEST(ScanOrder, another_model_of_a_scan_keeps_what_is_not_said_and_what_concerns_the_scanner) {
  const auto scan = parse_scan_order({{"scanner", "rig"}, {"steps", 90}, {"length", 5}});
  const auto order = parse_reprocess_order({{"sampling", "paper"}, {"bits", 12}}, *scan);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->steps, 90);
  EXPECT_EQ(order->length, 5);
  EXPECT_EQ(order->sampling, Sampling::kPaper);
  EXPECT_EQ(order->bits, 12);
  const auto other = parse_reprocess_order({{"steps", 100}}, *scan);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().front().field, "steps");
}

}  // namespace
}  // namespace vitrine
