// SPDX-License-Identifier: Apache-2.0
// Finds the attributes of a glTF primitive, compressed or not.
#pragma once

#include <string>

#include "codec/gltf/draco_primitive.h"
#include "codec/gltf/gltf_accessor.h"

namespace vitrine::inline codec {

struct GltfPrimitive {
  const Json& json;
  const DracoPrimitive* decoded = nullptr;  // null if the primitive is not Draco-compressed
  std::uint64_t needed = 0;  // the number of vertices to which the indices refer; 0 if unknown

  const Json& attributes() const { return member(json, "attributes"); }
  bool has(std::string_view name) const { return accessor(name) != kAbsent; }
  std::uint64_t accessor(std::string_view name) const { return whole(attributes(), name, kAbsent); }

  // Returns the values of an attribute: from `decoded` if it contains the attribute, otherwise from
  // a buffer view.
  Expected<Accessor> open(const Json& document, GltfBuffer& buffer, std::string_view name) const {
    const std::uint64_t index = accessor(name);
    if (decoded != nullptr) {
      const auto it = decoded->values.find(name);
      if (it != decoded->values.end()) return Accessor::over(document, it->second, index);
    }
    return Accessor::open(document, buffer, index, needed);
  }
};

}  // namespace vitrine::inline codec
