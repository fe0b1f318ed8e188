// SPDX-License-Identifier: Apache-2.0
// Finds the meshes that the scene of a glTF document shows, and where it places them.
#pragma once

#include <vector>

#include "codec/gltf/affine.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

struct MeshInstance {
  std::uint64_t mesh;  // index of the mesh; may be out of range
  Affine place;        // maps the mesh's coordinates to the scene's
};

// Returns the meshes of the document's default scene in depth-first order. If the document names no
// default, the first scene is used. If it has no scenes, all its meshes are returned without a
// transform.
//
// Fails (kBadInput) if a node does not exist, has two parents, is in a cycle or has an invalid
// transform. Also fails if meshes exist but the scene shows none of them.
Expected<std::vector<MeshInstance>> mesh_instances(const Json& document);

}  // namespace vitrine::inline codec
