// SPDX-License-Identifier: Apache-2.0
// Prepares the textures of a surface for the renderer.
#pragma once

#include <memory>

#include "codec/render/textures.h"
#include "server/cli/support/surface_file.h"

namespace vitrine::server::cli {

// Takes the texturing out of `surface` and decodes its pictures. Returns null if the texturing is
// empty. Must run in the sandbox if the bytes are untrusted. Fails if a picture cannot be decoded,
// or if the pictures together have more pixels than Limits allows.
//
// Readers of mesh files have already multiplied the vertex colours by the factors and maps, and a
// renderer would multiply all three again. Therefore this function removes the vertex colours if a
// base colour has a map, and otherwise the factors.
Expected<std::unique_ptr<Textures>> take_textures(SurfaceInput& surface);

}  // namespace vitrine::server::cli
