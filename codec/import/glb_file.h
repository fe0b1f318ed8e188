// SPDX-License-Identifier: Apache-2.0
// The container of binary glTF 2.0: a JSON document and a chunk of binary data.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/limits.h"
#include "codec/import/gltf_json.h"

namespace vitrine {

struct GlbFile {
  Json document;                         // an object
  std::span<const std::uint8_t> binary;  // of the input; may be empty
};

// Fails (kBadInput, kUnsupported, kLimit) on another version, cut or damaged chunks, JSON that is
// too long or too deep, and on required extensions that are not read.
Expected<GlbFile> open_glb(std::span<const std::uint8_t> bytes, const Limits& limits);

// A fault of the file, with the next step.
Unexpected bad_glb(std::string what);

}  // namespace vitrine
