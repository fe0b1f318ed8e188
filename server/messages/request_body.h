// SPDX-License-Identifier: Apache-2.0
// Checks the JSON or form in the body of a request: its media type, size and depth.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>

namespace vitrine::server {

// Largest size of a JSON body in bytes: for BodyKind::kJson and for BodyKind::kLargeJson.
inline constexpr std::size_t kMaxRequestBody = 64 * 1024, kMaxLargeRequestBody = 1024 * 1024;
inline constexpr int kMaxBodyDepth = 16;           // levels of nested arrays and objects
inline constexpr std::size_t kMaxForm = 8 * 1024;  // largest size of a form, in bytes

struct BodyFault {
  unsigned status;  // HTTP status: 400, 413 or 415
  std::string_view detail;
};

// Parses `text` as a JSON object. An empty `text` gives an empty object. Fails if the media type is
// neither application/json nor application/merge-patch+json, if the text is larger than `most`
// bytes or not an object, if it is nested too deep, or if a name occurs twice in an object.
tl::expected<nlohmann::json, BodyFault> parse_body(std::string_view media_type,
                                                   std::string_view text,
                                                   std::size_t most = kMaxRequestBody);

// Returns a fault if the form `text` is larger than kMaxForm, or if the media type is not
// application/x-www-form-urlencoded. Otherwise returns nullopt.
std::optional<BodyFault> form_fault(std::string_view media_type, std::string_view text);

}  // namespace vitrine::server
