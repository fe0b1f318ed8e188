// SPDX-License-Identifier: Apache-2.0
// Parses and checks the JSON document of a glTF 2.0 file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codec/core/limits.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

// Returns the JSON document, which is an object. Fails (kBadInput, kUnsupported, kLimit) in these
// cases:
// - The text is not JSON or is nested too deeply.
// - The text has more than `limits.header_bytes` bytes apart from its data: URIs.
// - The version is not supported.
// - The document requires an unsupported extension that changes or compresses the geometry.
Expected<Json> parse_gltf(std::string_view json, const Limits& limits);

// Returns one line about the required extensions that are ignored, or no line if there are none.
std::vector<std::string> report_extensions(const Json& document);

// Returns an error that states the fault `what` and advises the user what to do.
Unexpected bad_gltf(std::string what);

}  // namespace vitrine::inline codec
