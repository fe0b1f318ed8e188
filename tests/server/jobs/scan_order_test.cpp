// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scan_order.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace vitrine::server {
namespace {

using Json = nlohmann::json;

// Returns the name of the faulty field. Returns "" if the order has no fault or several faults.
std::string fault_in(const Json& body) {
  const auto order = parse_scan_order(body);
  if (order || order.error().size() != 1) return "";
  return order.error().front().field;
}

TEST(ScanOrder, AScannerIsEnough) {
  const auto order = parse_scan_order({{"scanner", "rig"}});
  ASSERT_TRUE(order);
  EXPECT_EQ(order->request.steps, 720);
  const acquisition::Processing otherwise;  // the defaults, which the command line also uses
  EXPECT_EQ(order->request.processing.stripe, otherwise.stripe);
  EXPECT_EQ(order->request.processing.sampling.window, otherwise.sampling.window);
  EXPECT_EQ(order->request.processing.sampling.method, otherwise.sampling.method);
  EXPECT_FALSE(order->is_public);
}

TEST(ScanOrder, AnOrderIsReadBackFromItsText) {
  const Json body = {
      {"scanner", "rig"},
      {"steps", 90},
      {"calibration", 2},
      {"exposure", 2500.5},
      {"keep_frames", true},
      {"stripe", "blais-rioux"},
      {"sampling", "paper"},
      {"length", 15},
      {"largest_angle", 62.5},
      {"largest_hole", 0},
      {"bits", 14},
      {"placement", "pyramid"},
      {"publish", true},
      {"metadata", {{"title", "T"}, {"creator", "C"}, {"rights", "R"}, {"licence", "CC0-1.0"}}}};
  const auto order = parse_scan_order(body);
  ASSERT_TRUE(order);
  EXPECT_EQ(Json::parse(to_json_text(*order)), body);
  const auto again = parse_reprocess_order({{"calibration", 3}}, *order);
  ASSERT_TRUE(again);
  const auto kept = parse_kept_order(Json::parse(to_json_text(*again)));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->calibration, 3);
  EXPECT_EQ(kept->request.processing.stripe.method, acquisition::StripeMethod::kBlaisRioux);
}

TEST(ScanOrder, EachFaultNamesItsField) {
  const Json good = {{"scanner", "rig"}};
  const std::pair<const char*, std::vector<Json>> wrong[] = {
      {"scanner", {1, "two\nlines"}},
      {"steps", {7, 36'001, 12.5, "720", nullptr, 1e300}},
      {"exposure", {0, -1, 1e9, "fast"}},
      {"stripe", {"peak", 0}},
      {"sampling", {"random", 1}},
      {"length", {0, 1, 6, 25, 10.0, "ten"}},
      {"largest_angle", {-1, 91, "steep"}},
      {"largest_hole", {-0.5, 1001, true}},
      {"calibration", {0, "newest"}},
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
  EXPECT_EQ(fault_in({{"scanner", "rig"}, {"metadata", {{"colour", "1"}}}}), "metadata.colour");
}

TEST(CalibrationOrder, HasTheNumberOfPosesAndAWebhook) {
  const auto order = parse_calibration_order({{"poses", 7}, {"webhook", "http://museum.example"}});
  ASSERT_TRUE(order);
  EXPECT_EQ(order->poses, 7);
  EXPECT_EQ(order->webhook, "http://museum.example");
  EXPECT_EQ(parse_calibration_order(Json::parse(to_json_text(*order)))->poses, 7);
  EXPECT_TRUE(parse_calibration_order(Json::object()));
  for (const Json& wrong : {Json{{"poses", 2}}, Json{{"poses", "many"}}, Json{{"places", 7}}})
    EXPECT_FALSE(parse_calibration_order(wrong)) << wrong;
}

TEST(ScanOrder, AllFaultsAreReportedAtOnce) {
  const auto order = parse_scan_order({{"steps", 0}, {"bits", 1}});
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().size(), 3u);
}

TEST(ScanOrder, ReprocessingKeepsOptionsNotGivenAndThoseOfTheScanner) {
  const auto scan = parse_scan_order({{"scanner", "rig"}, {"steps", 90}, {"length", 15}});
  const auto order = parse_reprocess_order(
      {{"sampling", "paper"}, {"stripe", "centre-of-mass"}, {"calibration", 2}, {"bits", 12}},
      *scan);
  ASSERT_TRUE(order);
  const auto& [stripe, sampling, surface] = order->request.processing;
  EXPECT_EQ(order->request.steps, 90);
  EXPECT_EQ(sampling.window, 15);
  EXPECT_EQ(sampling.method, acquisition::SamplingMethod::kPaper);
  EXPECT_EQ(stripe.method, acquisition::StripeMethod::kCentreOfMass);
  EXPECT_EQ(order->calibration, 2);
  EXPECT_EQ(order->bits, 12);
  for (const Json& wrong : {Json{{"steps", 100}}, Json{{"calibration", 0}}}) {
    const auto other = parse_reprocess_order(wrong, *scan);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().front().field, wrong.begin().key());
  }
}

}  // namespace
}  // namespace vitrine::server
