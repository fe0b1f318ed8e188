// SPDX-License-Identifier: Apache-2.0
// Encodes a hierarchy as the contents of a `.pmesh`: base mesh, chunks, and the manifest that lists
// them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/coding/mesh_state.h"
#include "codec/core/expected.h"
#include "codec/format/hierarchy.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

struct EncodedModel {
  // The manifest without errors, display filters and offsets, which are not known yet.
  Manifest manifest;
  // The file after its header: base mesh, then chunks in level order.
  std::vector<std::uint8_t> body;
};

// Called with each level, from the base mesh to the finest one. `level` is exactly the state that a
// decoder reaches.
using LevelSink = std::function<void(const MeshState& level)>;

// Encodes all levels of `hierarchy`. Frees each level's collapses before it calls `on_level`. Fails
// (kBadInput) if Draco cannot encode the base mesh.
Expected<EncodedModel> encode_model(Hierarchy hierarchy, const LevelSink& on_level);

}  // namespace vitrine::inline codec
