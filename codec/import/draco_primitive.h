// SPDX-License-Identifier: Apache-2.0
// Primitives of glTF that are compressed with KHR_draco_mesh_compression.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "codec/core/limits.h"
#include "codec/core/vec.h"
#include "codec/import/gltf_json.h"

namespace vitrine {

struct DracoPrimitive {
  std::vector<Triangle> faces;
  // By the attribute's name ("POSITION", "COLOR_0", "TEXCOORD_n"): the values in the component type
  // of its accessor, without gaps.
  std::map<std::string, std::vector<std::uint8_t>, std::less<>> values;

  std::uint64_t bytes() const;
};

// Decodes `compressed`, the buffer view of a primitive with that extension, by decode_draco_data():
// in the sandbox. Fails (kBadInput, kUnsupported, kLimit).
Expected<DracoPrimitive> decode_draco_primitive(std::span<const std::uint8_t> compressed,
                                                const Json& document, const Json& primitive,
                                                const Limits& limits);

}  // namespace vitrine
