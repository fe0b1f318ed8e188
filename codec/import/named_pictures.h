// SPDX-License-Identifier: Apache-2.0
// Loads the pictures to which OBJ and PLY files refer. Decodes each picture once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/linear_colour.h"
#include "codec/import/companions.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

class NamedPictures {
 public:
  // Decodes at most `most_pixels` pixels. `companions` must outlive this object.
  NamedPictures(const Companions& companions, std::uint64_t most_pixels)
      : companions_(companions), pixels_left_(most_pixels) {}

  // Returns the picture `name`, or null if it is missing or cannot be decoded. The picture lives as
  // long as this object.
  const Picture* find(std::string_view name);

  // Reports which of the requested pictures were used for colours or ignored, one line per kind.
  std::vector<std::string> report() const;

 private:
  const Companions& companions_;
  std::map<std::string, std::optional<Picture>, std::less<>> pictures_;
  std::vector<std::string> faults_;
  std::uint64_t pixels_left_;
};

// Returns the colour of `picture` at (u, v), where (0, 0) is the lower left corner.
LinearColour sample_upwards(const Picture& picture, double u, double v);

}  // namespace vitrine::inline codec
