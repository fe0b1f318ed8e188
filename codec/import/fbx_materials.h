// SPDX-License-Identifier: Apache-2.0
// Reads the materials and the embedded pictures of an FBX file.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "codec/files/companions.h"
#include "codec/import/obj_materials.h"

struct aiScene;

namespace vitrine::inline codec {

// Returns the companions (the files beside the model) together with the pictures in the scene. If a
// picture and a companion have the same name, the picture wins, unless the scene has several
// pictures of that name. The result is valid as long as the arguments.
Companions with_embedded_pictures(const aiScene& scene, const Companions& beside);

// Defines all materials of the scene. Returns their names in the order of the scene's materials.
// Returns an empty name for the grey material that Assimp assigns to meshes without a material, and
// does not define it. Adds the kinds of maps that are not kept to `unread`.
std::vector<std::string> define_fbx_materials(const aiScene& scene, ObjMaterials& materials,
                                              std::set<std::string>& unread);

}  // namespace vitrine::inline codec
