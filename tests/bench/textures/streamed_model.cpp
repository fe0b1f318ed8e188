// SPDX-License-Identifier: Apache-2.0
#include "streamed_model.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "checked.h"
#include "codec/appearance/views.h"
#include "codec/build/open_model.h"
#include "codec/picture/decode_picture.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

// Two rules of the viewer (web/src/three). kLevelBeforePictures is the level after which it fetches
// pictures. kSharpness is the number of texels on the side of a picture per pixel of the model's
// size on the screen.
constexpr std::uint32_t kLevelBeforePictures = 2;
constexpr double kSharpness = 1.5;

// Returns the numbers of the pictures of a role, in ascending order of size.
std::vector<std::size_t> pictures_of(const TextureInfo& texture, PictureRole role) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < texture.pictures.size(); ++i) {
    if (texture.pictures[i].role == role) numbers.push_back(i);
  }
  return numbers;
}

std::vector<std::vector<std::size_t>> picture_sets(const TextureInfo& texture) {
  const auto colours = pictures_of(texture, PictureRole::kBaseColour),
             normals = pictures_of(texture, PictureRole::kNormal);
  std::vector<std::vector<std::size_t>> sets;
  for (std::size_t step = 0; step < colours.size(); ++step) {
    sets.push_back({colours[step]});
    if (!normals.empty())
      sets.push_back({colours[step], normals[std::min(step, normals.size() - 1)]});
  }
  return sets;
}

Texturing texturing_of(const Refiner& refiner, bool has_normals) {
  const TextureInfo& info = refiner.manifest().texture;
  Material material{.alpha_mode = info.alpha_mode,
                    .alpha_cutoff = info.alpha_cutoff,
                    .is_double_sided = info.is_double_sided,
                    .is_unlit = info.is_unlit};
  material.base_colour_map = TextureMap{.wrap_u = Wrap::kClamp, .wrap_v = Wrap::kClamp};
  if (has_normals) {
    material.normal_map = material.base_colour_map;
    material.normal_map->picture = 1;
  }
  Texturing out;
  out.materials.push_back(material);
  out.face_materials.assign(refiner.face_count(), 0);
  out.coordinates[0] = refiner.texture_coordinates();
  return out;
}

}  // namespace

StreamedModel::StreamedModel(std::vector<std::uint8_t> file)
    : file_(std::move(file)),
      manifest_(checked(parse_header(file_))),
      picture_sets_(picture_sets(manifest_.texture)) {
  if (picture_sets_.empty()) throw std::runtime_error("the model was built without its texture");
}

double StreamedModel::ssim(const AppearanceReference& reference, const ModelState& state) const {
  Refiner refiner = checked(open_model(file_));
  const ChunkReader read = chunks_of(manifest_, file_);
  for (std::size_t i = 0; i < state.geometry; ++i)
    checked(refiner.apply(i, checked(read(i))));
  const auto& set = picture_sets_[state.pictures];
  std::vector<Picture> pictures;
  for (const std::size_t number : set) {
    const auto bytes = checked(picture_of(manifest_, file_, number));
    pictures.push_back(checked(decode_picture(bytes, UINT64_MAX)));
  }
  const Textures textures(texturing_of(refiner, set.size() > 1), std::move(pictures));
  TriangleMesh mesh = refiner.display_mesh();
  mesh.attributes.colours.clear();  // the picture contains the colours
  return checked(reference.compare({.mesh = mesh, .textures = &textures})).ssim;
}

StateBytes StreamedModel::bytes() const {
  StateBytes bytes;
  bytes.geometry.push_back(static_cast<double>(manifest_.head_bytes()));
  for (const ChunkInfo& chunk : manifest_.chunks)
    bytes.geometry.push_back(bytes.geometry.back() + static_cast<double>(chunk.length));
  for (const auto& set : picture_sets_) {
    double sum = 0;
    for (const std::size_t number : set) {
      if (number >= manifest_.texture.in_head)
        sum += static_cast<double>(manifest_.texture.pictures[number].length);
    }
    bytes.pictures.push_back(sum);
  }
  return bytes;
}

ModelState StreamedModel::finest() const {
  return {manifest_.chunks.size(), picture_sets_.size() - 1};
}

std::vector<ModelState> StreamedModel::viewer_path() const {
  const auto is_wanted = [&](const std::vector<std::size_t>& set) {
    return manifest_.texture.pictures[set[0]].side >= kSharpness * kViewSize;
  };
  const auto wanted = std::ranges::find_if(picture_sets_, is_wanted);
  const std::size_t step = picture_sets_.back().size();  // number of sets per size of pictures
  const std::size_t first = wanted == picture_sets_.end()
                                ? picture_sets_.size() - step
                                : static_cast<std::size_t>(wanted - picture_sets_.begin());
  std::size_t chunks = 0;
  std::vector<ModelState> path = {{0, 0}};
  while (chunks < manifest_.chunks.size() && manifest_.chunks[chunks].level <= kLevelBeforePictures)
    path.push_back({++chunks, 0});
  for (std::size_t set = first; set < first + step; ++set)
    path.push_back({chunks, set});
  while (chunks < manifest_.chunks.size())
    path.push_back({++chunks, first + step - 1});
  return path;
}

}  // namespace vitrine::bench
