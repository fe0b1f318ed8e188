// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "acquisition/session/scan_request.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

ScanRecord example_record() {
  ScanRecord record;
  record.request = {.steps = 360,
                    .exposure_us = 1234.5,
                    .keeps_frames = true,
                    .processing = {.stripe = {.method = StripeMethod::kBlaisRioux, .width = 1.1},
                                   .sampling = {.method = SamplingMethod::kPaper, .window = 20},
                                   .surface = {.largest_angle = 71, .largest_hole = 0.1}}};
  record.created = "2026-11-23T08:00:00Z";
  record.scanner = "left \"one\"";
  record.camera = "serial \xFF";
  record.settings = {.exposure_us = 1234.5, .gain_db = -3, .region = {1, 2, 300, 400}};
  record.board = "horus 123";
  record.calibration = 17;
  record.calibration_digest = "0123abcd";
  return record;
}

TEST(ScanRecord, WhatIsWrittenIsReadAgain) {
  const std::string text = to_json_text(example_record());
  const auto record = scan_record_of(text, "scan.json");
  ASSERT_TRUE(record) << record.error().message;
  EXPECT_EQ(to_json_text(*record), text);
  EXPECT_EQ(record->request.processing.stripe, example_record().request.processing.stripe);
  EXPECT_EQ(record->request.processing.surface.largest_hole, 0.1);
  EXPECT_EQ(record->settings, example_record().settings);
  EXPECT_EQ(record->calibration, 17);
  EXPECT_EQ(record->calibration_digest, "0123abcd");
}

TEST(ScanRecord, AFaultNamesFileAndKey) {
  const auto fault = [](std::string_view text) {
    return scan_record_of(text, "x/scan.json").error().message;
  };
  EXPECT_THAT(fault("nothing"), HasSubstr("x/scan.json is not a JSON object"));
  EXPECT_THAT(fault("[[[[[[[[[[[[[[[[[[[[[["), HasSubstr("is not a JSON object"));
  EXPECT_THAT(fault("{}"), HasSubstr("\"steps\" is missing"));
  EXPECT_THAT(fault(R"({"steps": 7})"), HasSubstr("\"steps\" must be a whole number from 8"));
  EXPECT_THAT(fault(R"({"steps": 72, "speed": 1})"), HasSubstr("\"speed\" is an unknown key"));
  EXPECT_THAT(fault(R"({"steps": 72, "sampling": {"method": "best"}})"),
              HasSubstr("scan.json: sampling: \"method\" must be one of equidistant, paper"));
  EXPECT_THAT(fault(R"({"steps": 72, "region": 5})"), HasSubstr("\"region\" must be an object"));
  EXPECT_THAT(fault(R"({"steps": 72, "keep_frames": 1})"), HasSubstr("true or false"));
  EXPECT_THAT(fault(std::string(2 << 20, ' ')), HasSubstr("longer than"));
}

}  // namespace
}  // namespace vitrine::test
