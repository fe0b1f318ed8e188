// SPDX-License-Identifier: Apache-2.0
// From a hierarchy to the bytes of a `.pmesh`: base mesh, chunks and the manifest that lists them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/hierarchy.h"
#include "codec/progressive/manifest.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

struct EncodedModel {
  Manifest manifest;               // without errors and display filters, offsets not laid out
  std::vector<std::uint8_t> body;  // the file behind its header: base mesh, chunks in level order
};

// Sees each level as every decoder will reach it, the base mesh first.
using LevelSink = std::function<void(const MeshState& level)>;

// Codes all levels of `hierarchy`; gives the memory of each level back before `on_level` sees what
// it led to. Fails (kBadInput) where Draco cannot encode the base mesh.
Expected<EncodedModel> encode_model(Hierarchy hierarchy, const LevelSink& on_level);

}  // namespace vitrine
