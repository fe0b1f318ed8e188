// SPDX-License-Identifier: Apache-2.0
// Writes the material of a USD layer.
#pragma once

#include "codec/export/file_writer.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Writes the prim </model/material>, a UsdPreviewSurface [USDPreview] for a mesh with the texture
// coordinates "st". `texturing` must meet the requirements of write_textured_mesh().
void put_usd_material(FileWriter& out, const Texturing& texturing);

// Writes the prim </model/material> for a mesh without a texture. If the mesh is coloured, the
// surface has the colours "displayColor" of its vertices, otherwise it is white.
void put_plain_usd_material(FileWriter& out, bool is_coloured);

}  // namespace vitrine::inline codec
