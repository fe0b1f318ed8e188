// SPDX-License-Identifier: Apache-2.0
// Finds the meshes in the scene of a glTF document, and their transforms.
#pragma once

#include <string>
#include <vector>

#include "codec/gltf/affine.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

struct MeshInstance {
  std::uint64_t mesh;            // index of the mesh; may be out of range
  std::uint64_t node = kAbsent;  // index of the node that has the mesh
  Affine place;                  // maps the node's coordinates to scene coordinates
};

struct GltfScene {
  std::vector<MeshInstance> meshes;  // in depth-first order
  // Per node: maps the node's coordinates to scene coordinates. Empty if the document has no skins.
  std::vector<Affine> places;
};

// Returns the meshes of the document's default scene. If the document names no default scene, the
// first scene is used. If the document has no scenes, returns all its meshes without a transform.
//
// Leaves out a node that KHR_node_visibility hides, and the nodes below it.
//
// Fails (kBadInput) if a node does not exist, has two parents, is in a cycle or has an invalid
// transform. Also fails if the document has meshes but the scene shows none of them.
Expected<GltfScene> read_scene(const Json& document);

// Returns one line for each kind of content that read_scene() leaves out: hidden nodes, other
// scenes, and meshes outside all scenes. Adds one about material variants, because only the default
// materials are read.
std::vector<std::string> report_scene(const Json& document);

}  // namespace vitrine::inline codec
