// SPDX-License-Identifier: Apache-2.0
// The textures of a surface, ready for the renderer.
#pragma once

#include <memory>

#include "codec/render/textures.h"
#include "server/cli/support/surface_file.h"

namespace vitrine::server::cli {

// Takes the texturing out of `surface` and decodes its pictures. Returns null if it is empty. Must
// run in the sandbox if the bytes are untrusted. Fails if a picture cannot be decoded, or if all
// have more pixels than Limits allows.
//
// A renderer multiplies vertex colours, factors and maps, but readers bake factors and maps into
// the vertex colours. So this function removes the vertex colours if a base colour has a map, or
// else the factors.
Expected<std::unique_ptr<Textures>> take_textures(SurfaceInput& surface);

}  // namespace vitrine::server::cli
