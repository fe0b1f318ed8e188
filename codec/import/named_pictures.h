// SPDX-License-Identifier: Apache-2.0
// The pictures that OBJ and PLY files name, decoded once each.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/import/companions.h"
#include "codec/import/image.h"

namespace vitrine {

class NamedPictures {
 public:
  explicit NamedPictures(const Companions& companions) : companions_(companions) {}

  // Null where it is missing or cannot be decoded. Lives as long as this.
  const Image* find(std::string_view name);

  // What became of those that were asked for, one line each kind.
  std::vector<std::string> report() const;

 private:
  const Companions& companions_;
  std::map<std::string, std::optional<Image>, std::less<>> pictures_;
  std::vector<std::string> faults_;
  std::uint64_t pixels_left_ = kMostPixels;
};

// The colour of `picture` where the origin of the coordinates is its lower left corner.
LinearColour sample_upwards(const Image& picture, double u, double v);

}  // namespace vitrine
