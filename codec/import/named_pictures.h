// SPDX-License-Identifier: Apache-2.0
// Loads the pictures to which OBJ and PLY files refer. Loads each picture only once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/limits.h"
#include "codec/core/linear_colour.h"
#include "codec/files/companions.h"
#include "codec/picture/carried_pictures.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

class NamedPictures {
 public:
  // Decodes at most `limits.pixels` pixels and keeps at most `limits.picture_bytes` bytes of
  // pictures. The arguments must outlive this object.
  NamedPictures(const Companions& companions, const Limits& limits)
      : companions_(companions), limits_(limits), pixels_left_(limits.pixels) {}

  // Decodes the picture `name`. Returns null if the picture is missing or cannot be decoded. The
  // pointer is valid as long as this object.
  const Picture* find(std::string_view name);

  // Keeps the picture `name` for the mesh and returns its index. Returns nullopt if the picture is
  // missing, is not PNG, JPEG or WebP, or was found to be damaged.
  std::optional<std::uint32_t> carry(std::string_view name);

  // Whether the picture `name` looks like a tangent-space normal map. Normal maps are mostly light
  // blue; height maps are grey.
  bool shows_normals(std::string_view name);

  std::vector<EncodedPicture> take() { return carried_.take(); }

  // Returns one line for each picture that cannot be decoded or kept.
  std::vector<std::string> report_faults() const;
  // Returns a line with the number of pictures that find() has decoded.
  std::vector<std::string> report_decoded() const;

 private:
  Expected<std::span<const std::uint8_t>> bytes(std::string_view name) const;
  void note_fault(std::string_view name, const std::string& fault);

  struct Fault {
    std::string name, text;  // the picture's name in the file, and the fault with a next step
  };

  const Companions& companions_;
  const Limits& limits_;
  CarriedPictures carried_;
  // The keys of the maps are the companion_key() of the names, because different names may refer to
  // the same file.
  std::map<std::string, std::optional<Picture>> decoded_;
  std::map<std::string, bool> shows_normals_;
  std::map<std::string, Fault> faults_;
  std::uint64_t pixels_left_;
};

// Returns the colour of `picture` at (u, v), where (0, 0) is the lower left corner.
LinearColour sample_upwards(const Picture& picture, double u, double v);

// Converts (u, v) from coordinates with (0, 0) at the lower left corner to (0, 0) at the upper
// left.
inline TextureCoordinates from_upwards(double u, double v) {
  return {static_cast<float>(u), static_cast<float>(1 - v)};
}

}  // namespace vitrine::inline codec
