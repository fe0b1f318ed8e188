// SPDX-License-Identifier: Apache-2.0
// What an operator asks of a scan, and of what is made of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "acquisition/session/scan_request.h"
#include "codec/simplify/simplify.h"
#include "server/jobs/order_fields.h"

namespace vitrine {

struct ScanOrder {
  std::string scanner;  // its name
  ScanRequest request;
  int calibration = 0;  // its number; 0: the newest, or the own of a scan that is made anew

  int bits = 0;  // as in BuildOptions
  Placement placement = Placement::kMidpoint;

  ModelMetadata metadata;
  bool publish = false;  // else a draft comes of it
  std::string webhook;   // a URL that is told of the end; empty: none
};

inline constexpr int kLeastPoses = 3, kMostPoses = 200;

struct CalibrationOrder {
  int poses = 20;            // of the target, that somebody places by hand
  std::string webhook = {};  // as in ScanOrder
};

// A new scan. All faults at once; a field that is not known is one.
tl::expected<ScanOrder, FieldFaults> parse_scan_order(const nlohmann::json& body);

// Another model of the scan that was ordered as `scan`, whose own wishes are the defaults: what
// concerns the scanner is fixed.
tl::expected<ScanOrder, FieldFaults> parse_reprocess_order(const nlohmann::json& body,
                                                           const ScanOrder& scan);

// Also what was kept.
tl::expected<CalibrationOrder, FieldFaults> parse_calibration_order(const nlohmann::json& body);
std::string to_json_text(const CalibrationOrder& order);

// An order of either kind of scan as it is kept until it is carried out, and what was kept.
std::string to_json_text(const ScanOrder& order);
tl::expected<ScanOrder, FieldFaults> parse_kept_order(const nlohmann::json& kept);

}  // namespace vitrine
