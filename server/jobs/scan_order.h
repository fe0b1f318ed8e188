// SPDX-License-Identifier: Apache-2.0
// Reads and writes requests to scan, to rebuild a scan's mesh, and to calibrate.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "acquisition/session/scan_request.h"
#include "codec/core/expected.h"
#include "codec/simplify/simplify.h"
#include "server/catalogue/jobs.h"
#include "server/jobs/order_fields.h"

namespace vitrine::server {

struct ScanOrder {
  std::string scanner;  // name of the scanner
  acquisition::ScanRequest request;
  // Number of the calibration. If 0, a new scan uses the newest calibration for its camera and
  // sensor region, and a rebuild uses the calibration of its scan.
  int calibration = 0;

  int bits = 0;  // see BuildOptions::bits
  Placement placement = Placement::kMidpoint;

  ModelMetadata metadata;
  bool is_public = false;  // whether the model is published at once; else it is a draft
  // Only for a rebuild: whether to publish the new model if visitors can see all levels of the
  // scan's current model at that time.
  bool is_public_as_before = false;
  std::string webhook;  // URL to call when the job ends; empty: none
};

inline constexpr int kLeastPoses = 3, kMostPoses = 200;

struct CalibrationOrder {
  int poses = 20;            // number of poses in which the operator places the target
  std::string webhook = {};  // see ScanOrder::webhook
};

// Parses a request for a new scan. Returns either the order or all faults of the request. An
// unknown field is a fault.
tl::expected<ScanOrder, FieldFaults> parse_scan_order(const nlohmann::json& body);

// Parses a request to rebuild the mesh of a stored scan. Options not given keep the values of
// `scan`. Options of the scanner cannot be changed. If the request says whether to publish,
// `is_public_as_before` becomes false.
tl::expected<ScanOrder, FieldFaults> parse_reprocess_order(const nlohmann::json& body,
                                                           const ScanOrder& scan);

// Parses a client's request, or a text that to_json_text() has written.
tl::expected<CalibrationOrder, FieldFaults> parse_calibration_order(const nlohmann::json& body);
std::string to_json_text(const CalibrationOrder& order);

// Returns the JSON text of an order for a scan or a rebuild, which the job's record stores.
// parse_kept_order() reads the parsed text.
std::string to_json_text(const ScanOrder& order);
tl::expected<ScanOrder, FieldFaults> parse_kept_order(const nlohmann::json& kept);

// Both functions parse a text that to_json_text() has written. If the text is malformed, the first
// function fails with kState. The second returns the default order, because earlier versions of
// Vitrine stored no text.
Expected<ScanOrder> stored_scan_order(const std::string& parameters);
CalibrationOrder stored_calibration_order(const std::string& parameters);

// Returns the entry of a new scan. If the order has no title, the title contains the current time.
ScanEntry new_scan(ScanOrder order);

}  // namespace vitrine::server
