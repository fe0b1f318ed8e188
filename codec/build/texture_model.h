// SPDX-License-Identifier: Apache-2.0
// Gives an encoded model a texture. Places a display atlas on its base mesh. Refines the mesh to
// full resolution as a decoder does, which gives the atlas coordinates of the fine faces. Then
// bakes the source's pictures into the atlas.
#pragma once

#include "codec/build/model_encoder.h"
#include "codec/core/expected.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// `mesh` is the mesh at full resolution. EncodedModel::fine_ids must be indices of its vertices,
// and `texturing` must describe its faces. Sets the texture of the manifest, and puts the atlas,
// the pictures and the originals into the body. Returns the notes of bake(), and a note if the
// originals were left out. Fails like bake() and place_atlas().
Expected<std::vector<std::string>> texture_model(const TriangleMesh& mesh, Texturing texturing,
                                                 EncodedModel& model);

}  // namespace vitrine::inline codec
