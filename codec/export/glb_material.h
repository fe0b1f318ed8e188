// SPDX-License-Identifier: Apache-2.0
// Writes the glTF JSON of materials, their textures and their images.
#pragma once

#include <span>

#include "codec/export/file_writer.h"
#include "codec/export/glb_description.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Writes the members "materials", "textures", "samplers" and "images" of glTF, each followed by a
// comma, and adds the extensions that they use. Image i is in buffer view `first_view` + i.
// `texturing` must meet the requirements of write_textured_mesh().
void put_materials(FileWriter& json, const Texturing& texturing, std::size_t first_view,
                   GlbExtensions& extensions);

}  // namespace vitrine::inline codec
