// SPDX-License-Identifier: Apache-2.0
// Encodes a hierarchy as the contents of a `.pmesh`: base mesh, chunks and manifest.
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
  // The manifest. Errors, display filters and offsets are not filled in yet.
  Manifest manifest;
  // The file after its header: base mesh, then chunks in level order.
  std::vector<std::uint8_t> body;
  BaseMesh base;                   // the base mesh as a decoder reconstructs it
  std::vector<VertexId> fine_ids;  // per vertex at full resolution: its vertex id in the hierarchy
};

// Callback that receives each level, from the base mesh to the finest level. `level` equals the
// state that a decoder reaches.
using LevelSink = std::function<void(const MeshState& level)>;

// Encodes all levels of `hierarchy` and calls `on_level` for each. Frees the memory of a level's
// collapses before the call for this level. Fails (kBadInput) if Draco cannot encode the base mesh.
Expected<EncodedModel> encode_model(Hierarchy hierarchy, const LevelSink& on_level);

}  // namespace vitrine::inline codec
