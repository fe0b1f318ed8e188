// SPDX-License-Identifier: Apache-2.0
// Decodes glTF primitives compressed with KHR_draco_mesh_compression.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "codec/core/limits.h"
#include "codec/core/vec.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

struct DracoPrimitive {
  std::vector<Triangle> faces;
  // The values of each attribute, by name ("POSITION", "COLOR_0", "TEXCOORD_n", "JOINTS_n",
  // "WEIGHTS_n"). Values have the component type of the attribute's accessor and are stored without
  // gaps.
  std::map<std::string, std::vector<std::uint8_t>, std::less<>> values;

  std::uint64_t bytes() const;
};

// Decodes `compressed`, the buffer view of a compressed primitive. Draco is not safe on hostile
// bytes: call this in the sandbox. Fails (kBadInput, kUnsupported, kLimit).
Expected<DracoPrimitive> decode_draco_primitive(std::span<const std::uint8_t> compressed,
                                                const Json& document, const Json& primitive,
                                                const Limits& limits);

}  // namespace vitrine::inline codec
