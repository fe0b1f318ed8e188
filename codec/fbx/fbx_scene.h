// SPDX-License-Identifier: Apache-2.0
// Imports an FBX file with Assimp, from memory and with its FBX importer alone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "codec/core/expected.h"

struct aiScene;

namespace vitrine::inline codec {

class FbxScene {
 public:
  // Imports the file, without cameras, lights, animations and skins. Call outline_of_fbx() first,
  // and call this in the sandbox if the bytes are untrusted: Assimp is not safe on hostile bytes.
  // Fails (kBadInput) with Assimp's reason. Assimp opens no other file.
  static Expected<FbxScene> import(std::span<const std::uint8_t> bytes);

  const aiScene& scene() const { return *scene_; }

 private:
  std::shared_ptr<const aiScene> scene_;
};

}  // namespace vitrine::inline codec
