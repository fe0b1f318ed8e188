// SPDX-License-Identifier: Apache-2.0
// Loads the pictures to which OBJ and PLY files refer. Decodes each picture once.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/import/companions.h"
#include "codec/import/image.h"

namespace vitrine::inline codec {

class NamedPictures {
 public:
  explicit NamedPictures(const Companions& companions) : companions_(companions) {}

  // Returns the picture `name`, or null if it is missing or cannot be decoded. The picture lives as
  // long as this object.
  const Image* find(std::string_view name);

  // Reports which of the requested pictures were used for colours or ignored, one line per kind.
  std::vector<std::string> report() const;

 private:
  const Companions& companions_;
  std::map<std::string, std::optional<Image>, std::less<>> pictures_;
  std::vector<std::string> faults_;
  std::uint64_t pixels_left_ = kMostPixels;
};

// Returns the colour of `picture` at (u, v), where (0, 0) is the lower left corner.
LinearColour sample_upwards(const Image& picture, double u, double v);

}  // namespace vitrine::inline codec
