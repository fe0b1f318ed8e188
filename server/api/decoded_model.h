// SPDX-License-Identifier: Apache-2.0
// Decodes a published model into a mesh at a requested level of detail.
#pragma once

#include <optional>
#include <vector>

#include "codec/build/coarser_levels.h"
#include "codec/build/exported_texture.h"
#include "codec/build/refine.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/plan/planner.h"
#include "server/store/published_model.h"

namespace vitrine::server {

struct DecodedModel {
  TriangleMesh mesh;  // without vertex colours if there is a texture
  // Textures in the form that write_textured_mesh() requires; empty if there is no texture.
  Texturing texturing;
  ShownDetail detail;
};

// Returns the mesh of the model at the level of detail `want`, turned and scaled as the model is
// presented, in the model's unit, with the smoothing that viewers apply (display filter).
// `texture_side` limits the side of the pictures in pixels, and `roles` selects the pictures, as in
// pictures_to_export(). The mesh gets no texture if `texture_side` is 0 or `roles` is empty.
// Decodes in this process, without a sandbox, because the file was checked when it was published.
Expected<DecodedModel> decoded_model(const PublishedModel& model, const Want& want,
                                     std::optional<std::uint32_t> texture_side,
                                     PictureRoles roles = PictureRoles().set());

// Decodes the levels of detail that an export contains besides `finest` (see
// codec/build/coarser_levels.h), turned and scaled like `finest`. Returns them from fine to coarse.
Expected<std::vector<CoarserLevel>> levels_below(const DecodedModel& finest,
                                                 const PublishedModel& model);

}  // namespace vitrine::server
