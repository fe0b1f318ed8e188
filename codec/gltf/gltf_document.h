// SPDX-License-Identifier: Apache-2.0
// Parses and checks the JSON document of a glTF 2.0 file.
#pragma once

#include <string>
#include <string_view>

#include "codec/core/limits.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

// Returns the document, which is a JSON object. Fails (kBadInput, kUnsupported, kLimit) if it is
// not JSON, if it is nested too deeply or has more than `limits.header_bytes` bytes apart from its
// data: URIs, or if its version or a required extension is not supported.
Expected<Json> parse_gltf(std::string_view json, const Limits& limits);

// Returns an error that states a fault of the file and advises the user.
Unexpected bad_gltf(std::string what);

}  // namespace vitrine::inline codec
