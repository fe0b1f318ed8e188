// SPDX-License-Identifier: Apache-2.0
// Parses and checks the JSON document of a glTF 2.0 file.
#pragma once

#include <string>
#include <string_view>

#include "codec/core/limits.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

// Returns the JSON document, which is an object. Fails (kBadInput, kUnsupported, kLimit) in these
// cases:
// - The text is not JSON or is nested too deeply.
// - The text has more than `limits.header_bytes` bytes apart from its data: URIs.
// - The version or a required extension is not supported.
Expected<Json> parse_gltf(std::string_view json, const Limits& limits);

// Returns an error that states the fault `what` and advises the user what to do.
Unexpected bad_gltf(std::string what);

}  // namespace vitrine::inline codec
