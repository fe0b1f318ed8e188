// SPDX-License-Identifier: Apache-2.0
// The copies of a node's mesh according to the glTF extension EXT_mesh_gpu_instancing.
#pragma once

#include <optional>

#include "codec/gltf/affine.h"
#include "codec/gltf/gltf_accessor.h"

namespace vitrine::inline codec {

class GltfInstances {
 public:
  // Reads the extension of node number `node`. Fails (kBadInput) if its accessors cannot be read or
  // differ in their counts.
  static Expected<GltfInstances> open(const Json& document, GltfBuffer& buffer, std::uint64_t node);

  // Returns the number of copies; 1 if the node lacks the extension.
  std::uint64_t count() const { return count_.value_or(1); }
  // Returns the transform of copy i, relative to the node.
  Affine operator[](std::uint64_t i) const;

 private:
  std::optional<std::uint64_t> count_;
  std::optional<Accessor> translation_, rotation_, scale_;
};

}  // namespace vitrine::inline codec
