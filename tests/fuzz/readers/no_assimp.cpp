// SPDX-License-Identifier: Apache-2.0
// Replaces Assimp, which is not safe on hostile bytes, in the fuzzer that reads all formats. The
// fuzzer of FBX uses Assimp.
#include "codec/fbx/fbx_scene.h"

namespace vitrine::inline codec {

Expected<FbxScene> FbxScene::import(std::span<const std::uint8_t>) {
  return fail(ErrorCode::kUnsupported, "FBX files are not imported here");
}

}  // namespace vitrine::inline codec
