// SPDX-License-Identifier: Apache-2.0
// The base colours of glTF materials. Each is a factor, optionally multiplied by a texture.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "codec/core/linear_colour.h"
#include "codec/import/gltf_buffer.h"
#include "codec/mesh/texturing.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

struct BaseColour {
  LinearColour factor{1, 1, 1};
  const Picture* image = nullptr;  // null if there is only the factor
  std::uint64_t texcoord = 0;      // n of the attribute TEXCOORD_n that the image uses
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  std::array<double, 2> offset{0, 0}, scale{1, 1};  // from KHR_texture_transform
  double rotation = 0;                              // from KHR_texture_transform, radians

  bool is_white() const { return image == nullptr && factor == LinearColour{1, 1, 1}; }
  LinearColour at(double u, double v) const;  // (u, v): texture coordinates as in the file
};

class GltfMaterials {
 public:
  // The references must outlive this object. Decodes at most `most_pixels` pixels.
  GltfMaterials(const Json& document, GltfBuffer& buffer, GltfResources& resources,
                std::uint64_t most_pixels)
      : document_(document), buffer_(buffer), resources_(resources), pixels_left_(most_pixels) {}

  // Returns the base colour of the primitive's material. The colour's image lives as long as this
  // object.
  BaseColour base_colour(const Json& primitive);

  // Reports which images of the document were used for colours or ignored, one line per kind.
  std::vector<std::string> report() const;

 private:
  const Picture* image(std::uint64_t index);
  Expected<Picture> decode(std::uint64_t index);

  const Json& document_;
  GltfBuffer& buffer_;
  GltfResources& resources_;
  // key: index of the image; value: nullopt if the image cannot be decoded
  std::map<std::uint64_t, std::optional<Picture>> images_;
  std::vector<std::string> faults_;
  std::uint64_t pixels_left_;
};

}  // namespace vitrine::inline codec
