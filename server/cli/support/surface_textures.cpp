// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/surface_textures.h"

#include <algorithm>
#include <utility>

#include "codec/core/limits.h"
#include "codec/render/material_pictures.h"

namespace vitrine::server::cli {
namespace {

void apply_colours_once(SurfaceInput& surface) {
  auto& materials = surface.texturing.materials;
  const auto has_map = [](const Material& material) {
    return material.base_colour_map.has_value();
  };
  if (std::ranges::any_of(materials, has_map)) {
    surface.mesh.attributes.colours.clear();
    return;
  }
  for (Material& material : materials)
    material.base_colour = {1, 1, 1, material.base_colour[3]};
}

}  // namespace

Expected<std::unique_ptr<Textures>> take_textures(SurfaceInput& surface) {
  if (surface.texturing.empty()) return nullptr;
  auto pictures = decode_pictures(surface.texturing, kShownMaps, Limits{}.pixels);
  if (!pictures) return tl::unexpected(pictures.error());
  apply_colours_once(surface);
  return std::make_unique<Textures>(std::move(surface.texturing), *std::move(pictures));
}

}  // namespace vitrine::server::cli
