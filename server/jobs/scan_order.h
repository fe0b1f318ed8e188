// SPDX-License-Identifier: Apache-2.0
// What an operator asks of a scan, and of what is made of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "codec/simplify/simplify.h"
#include "server/store/publish.h"

namespace vitrine {

enum class Sampling : std::uint8_t { kEquidistant, kPaper, kAdaptive };

struct ScanOrder {
  std::string scanner;             // its name
  int steps = 720;                 // of a turn
  std::optional<double> exposure;  // microseconds; nothing: the scanner's
  bool keep_frames = false;

  Sampling sampling = Sampling::kAdaptive;
  int length = 10;  // L, in points
  int bits = 0;     // as in BuildOptions
  Placement placement = Placement::kMidpoint;

  ModelMetadata metadata;
  bool publish = false;  // else a draft comes of it
};

struct FieldFault {
  std::string field, detail;  // "metadata.title"; what is expected
};
using FieldFaults = std::vector<FieldFault>;

// A new scan. All faults at once; a field that is not known is one.
tl::expected<ScanOrder, FieldFaults> parse_scan_order(const nlohmann::json& body);

// Another model of the scan that was ordered as `scan`, whose own wishes are the defaults: what
// concerns the scanner is fixed.
tl::expected<ScanOrder, FieldFaults> parse_reprocess_order(const nlohmann::json& body,
                                                           const ScanOrder& scan);

std::string to_json_text(const ScanOrder& order);  // parse_scan_order reads it

}  // namespace vitrine
