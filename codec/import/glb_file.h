// SPDX-License-Identifier: Apache-2.0
// The container of binary glTF 2.0: a JSON document and a chunk of binary data.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/limits.h"
#include "codec/import/gltf_json.h"

namespace vitrine::inline codec {

struct GlbFile {
  Json document;                         // a JSON object
  std::span<const std::uint8_t> binary;  // part of the input; may be empty
};

// Opens a GLB file. Fails (kBadInput, kUnsupported, kLimit) if the version is not supported, if a
// chunk is truncated or damaged, if the JSON is too long or too deep, or if a required extension is
// not supported.
Expected<GlbFile> open_glb(std::span<const std::uint8_t> bytes, const Limits& limits);

// Returns an error that states a fault of the file and advises the user.
Unexpected bad_glb(std::string what);

}  // namespace vitrine::inline codec
