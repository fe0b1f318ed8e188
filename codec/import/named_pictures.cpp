// SPDX-License-Identifier: Apache-2.0
#include "codec/import/named_pictures.h"

#include "codec/picture/decode_picture.h"
#include "codec/picture/sample.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

const Picture* NamedPictures::find(std::string_view name) {
  const auto [it, is_new] = pictures_.try_emplace(std::string(name));
  if (is_new) {
    const auto bytes = find_companion(companions_, name);
    auto image = bytes ? decode_picture(*bytes, pixels_left_)
                       : Expected<Picture>(bad_input("is not beside the mesh file"));
    if (image) {
      pixels_left_ -= std::uint64_t{image->width} * image->height;
      it->second = *std::move(image);
    } else {
      faults_.push_back("texture map " + in_quotes(name) + " not carried: it " +
                        image.error().message);
    }
  }
  return it->second ? &*it->second : nullptr;
}

std::vector<std::string> NamedPictures::report() const {
  std::vector<std::string> lines = faults_;
  const std::size_t baked = pictures_.size() - faults_.size();
  if (baked > 0) lines.push_back(counted(baked, "texture map") + " baked into vertex colours");
  return lines;
}

LinearColour sample_upwards(const Picture& picture, double u, double v) {
  return sample(picture, u, 1 - v, Wrap::kRepeat, Wrap::kRepeat);
}

}  // namespace vitrine::inline codec
