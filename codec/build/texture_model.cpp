// SPDX-License-Identifier: Apache-2.0
#include "codec/build/texture_model.h"

#include <algorithm>
#include <utility>

#include "codec/bake/bake.h"
#include "codec/build/atlas_footprint.h"
#include "codec/build/originals.h"
#include "codec/coding/atlas_coder.h"

namespace vitrine::inline codec {
namespace {

// A face's vertices, rotated so that the smallest index comes first, and the face's index.
struct FaceName {
  Triangle vertices;
  std::uint32_t face;
  std::uint32_t turns;  // index of the face's corner that comes first in `vertices`

  auto operator<=>(const FaceName&) const = default;
};

std::vector<FaceName> names_of(const std::vector<Triangle>& faces) {
  std::vector<FaceName> names;
  names.reserve(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const auto smallest = std::min_element(faces[f].begin(), faces[f].end());
    const auto turns = static_cast<std::uint32_t>(smallest - faces[f].begin());
    Triangle vertices = faces[f];
    std::rotate(vertices.begin(), vertices.begin() + turns, vertices.end());
    names.push_back({vertices, f, turns});
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The face of the mesh that has the same vertices as a face of the atlas. Corner k of the atlas's
// face is corner (`turns` + k) % 3 of this face.
struct SameFace {
  std::uint32_t face, turns;
};

// Returns, for each face of `atlas`, the face of `mesh` with the same vertices. Both have the same
// faces, but in different orders.
std::vector<SameFace> same_faces(const TriangleMesh& mesh, const PlacedAtlas& atlas) {
  const auto from = names_of(atlas.faces), to = names_of(mesh.faces);
  std::vector<SameFace> out(from.size());
  for (std::size_t i = 0; i < to.size(); ++i)
    out[from[i].face] = {to[i].face, (to[i].turns + 3 - from[i].turns) % 3};
  return out;
}

// Returns the coordinates in `atlas` of each face of the mesh, in the mesh's order.
std::vector<DisplayFace> display_faces(const PlacedAtlas& atlas, std::span<const SameFace> same) {
  std::vector<DisplayFace> out(same.size());
  for (std::size_t f = 0; f < same.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      out[same[f].face][(same[f].turns + k) % 3] =
          to_vec2(atlas.coordinates[f][k]) * (1.0 / atlas.side);
    }
  }
  return out;
}

// Returns `texturing` with its faces in the order of the atlas.
Texturing in_atlas_order(const Texturing& texturing, std::span<const SameFace> same) {
  Texturing out{.materials = texturing.materials,
                .pictures = texturing.pictures,
                .face_materials = {},
                .coordinates = {}};
  for (const auto& [face, turns] : same) {
    out.face_materials.push_back(texturing.face_materials[face]);
    for (std::size_t set = 0; set < kCoordinateSets; ++set) {
      if (texturing.coordinates[set].empty()) continue;
      auto corners = texturing.coordinates[set][face];
      std::rotate(corners.begin(), corners.begin() + turns, corners.end());
      out.coordinates[set].push_back(corners);
    }
  }
  return out;
}

TextureInfo info_of(const BakedTexture& baked, std::uint32_t side,
                    std::span<const std::uint8_t> atlas) {
  TextureInfo info{.side = side,
                   .atlas_length = atlas.size(),
                   .atlas_sha256 = sha256(atlas),
                   .alpha_mode = baked.alpha_mode,
                   .alpha_cutoff = baked.alpha_cutoff,
                   .is_double_sided = baked.is_double_sided,
                   .is_unlit = baked.is_unlit};
  for (const BakedPicture& picture : baked.pictures) {
    info.pictures.push_back({.role = picture.role,
                             .side = picture.side,
                             .length = picture.bytes.size(),
                             .sha256 = sha256(picture.bytes)});
  }
  // The head of the file, which viewers fetch first, holds only the coarsest picture of base
  // colours.
  info.in_head = info.pictures.empty() ? 0 : 1;
  return info;
}

}  // namespace

Expected<std::vector<std::string>> texture_model(const TriangleMesh& mesh, Texturing texturing,
                                                 EncodedModel& model) {
  auto atlas = place_atlas(model);
  if (!atlas) return tl::unexpected(atlas.error());
  const std::vector<SameFace> same = same_faces(mesh, *atlas);
  const Texturing source = in_atlas_order(texturing, same);
  auto baked = bake(mesh, std::move(texturing), display_faces(*atlas, same));
  if (!baked) return tl::unexpected(baked.error());

  BaseMesh base = model.base;
  base.atlas = std::move(atlas->base);
  std::vector<std::uint8_t> head = encode_atlas(base);
  model.manifest.texture = info_of(*baked, atlas->side, head);
  const std::uint32_t in_head = model.manifest.texture.in_head;
  for (std::size_t i = 0; i < baked->pictures.size(); ++i) {
    const auto& bytes = baked->pictures[i].bytes;
    std::vector<std::uint8_t>& part = i < in_head ? head : model.body;
    part.insert(part.end(), bytes.begin(), bytes.end());
  }
  const auto behind_base = static_cast<std::ptrdiff_t>(model.manifest.base_length);
  model.body.insert(model.body.begin() + behind_base, head.begin(), head.end());
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  if (!add_originals(atlas->faces, vertices, source, model.manifest, model.body)) {
    baked->notes.push_back("the source's " + std::to_string(source.pictures.size()) +
                           " pictures and their texture coordinates are not kept: too many "
                           "pictures; join them");
  }
  return std::move(baked->notes);
}

}  // namespace vitrine::inline codec
