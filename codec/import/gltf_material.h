// SPDX-License-Identifier: Apache-2.0
// The base colours of glTF materials: a factor and a texture map.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "codec/import/gltf_buffer.h"
#include "codec/import/image.h"

namespace vitrine {

struct BaseColour {
  LinearColour factor{1, 1, 1};
  const Image* image = nullptr;  // null: the factor alone
  std::uint64_t texcoord = 0;    // which TEXCOORD_n the image takes
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  std::array<double, 2> offset{0, 0}, scale{1, 1};  // KHR_texture_transform
  double rotation = 0;                              // radians

  bool is_white() const { return image == nullptr && factor == LinearColour{1, 1, 1}; }
  LinearColour at(double u, double v) const;  // of the texture coordinates in the file
};

class GltfMaterials {
 public:
  // Both must outlive this.
  GltfMaterials(const Json& document, GltfBuffer& buffer) : document_(document), buffer_(buffer) {}

  // Of the primitive's material. The image lives as long as this.
  BaseColour base_colour(const Json& primitive);

  // What became of the document's images, one line each kind.
  std::vector<std::string> report() const;

 private:
  const Image* image(std::uint64_t index);
  Expected<Image> decode(std::uint64_t index);

  const Json& document_;
  GltfBuffer& buffer_;
  std::map<std::uint64_t, std::optional<Image>> images_;  // nothing where it cannot be decoded
  std::vector<std::string> faults_;
  std::uint64_t pixels_left_ = kMostPixels;
};

}  // namespace vitrine
