// SPDX-License-Identifier: Apache-2.0
// The JSON body of a request, bounded.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>
#include <tl/expected.hpp>

namespace vitrine {

inline constexpr std::size_t kMaxRequestBody = 64 * 1024;  // bytes
inline constexpr int kMaxBodyDepth = 16;                   // of arrays and objects

struct BodyFault {
  unsigned status;  // 400, 413 or 415
  std::string_view detail;
};

// The object that `text` is; an empty one where `text` is empty. Anything else is a fault: another
// media type than application/json, another value than an object, one nested too deep, a name given
// twice in an object.
tl::expected<nlohmann::json, BodyFault> parse_body(std::string_view media_type,
                                                   std::string_view text);

}  // namespace vitrine
