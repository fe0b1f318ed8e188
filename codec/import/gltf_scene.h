// SPDX-License-Identifier: Apache-2.0
// Which meshes the scene of a glTF document shows, and where.
#pragma once

#include <vector>

#include "codec/import/affine.h"
#include "codec/import/gltf_json.h"

namespace vitrine {

struct PlacedMesh {
  std::uint64_t mesh;  // index; may be out of range
  Affine place;        // from the mesh's coordinates to the scene's
};

// The meshes of the document's scene (of its first one, where it names none) in depth-first order;
// all meshes, where they are, in a document without scenes. Fails (kBadInput) where a node does not
// exist, is met twice, which a cycle would do too, or is not placed by numbers, and where the scene
// shows none of the meshes there are.
Expected<std::vector<PlacedMesh>> placed_meshes(const Json& document);

}  // namespace vitrine
