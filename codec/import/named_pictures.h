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

  // Decodes the picture `path`. Returns null if the picture is missing or cannot be decoded. The
  // pointer is valid as long as this object.
  const Picture* find(const StatedPath& path);

  // Keeps the picture `path` for the mesh and returns its index. Returns nullopt if the picture is
  // missing, has a format that is not read, or was found to be damaged.
  std::optional<std::uint32_t> carry(const StatedPath& path);

  // Whether the picture `path` looks like a tangent-space normal map. Normal maps are mostly light
  // blue; height maps are grey.
  bool shows_normals(const StatedPath& path);

  std::vector<EncodedPicture> take() { return carried_.take(); }

  // Returns one line for each picture that cannot be decoded or kept, and one about pictures that
  // were converted.
  std::vector<std::string> report_faults() const;
  // Returns a line with the number of pictures that find() has decoded.
  std::vector<std::string> report_decoded() const;

 private:
  // A picture to which a path refers: its key in the maps below, and its bytes or the reason why it
  // cannot be found.
  struct Source {
    std::string key;
    Expected<std::span<const std::uint8_t>> bytes;
  };
  Source source_of(const StatedPath& path) const;
  Expected<Picture> decode(const Source& source);
  void note_fault(const Source& source, const StatedPath& path, const std::string& fault);

  struct PictureFault {
    std::string name, text;  // the picture's name in the file, and the fault with a next step
  };

  const Companions& companions_;
  const Limits& limits_;
  CarriedPictures carried_;
  // The keys of the maps are Source::key, not paths. Different paths may refer to the same file,
  // and equal paths in different folders may refer to different files.
  std::map<std::string, std::optional<Picture>> decoded_;
  std::map<std::string, bool> shows_normals_;
  std::map<std::string, PictureFault> faults_;
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
