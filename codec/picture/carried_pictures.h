// SPDX-License-Identifier: Apache-2.0
// Collects the encoded pictures of a mesh. Keeps each picture only once.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

class CarriedPictures {
 public:
  // Adds a picture and returns its index. If a picture with the same contents exists, returns that
  // picture's index. `bytes` must outlive this object.
  //
  // Fails (kUnsupported) if the picture is not PNG, JPEG or WebP. Fails (kLimit) if all different
  // spans added so far have more than `most_bytes` bytes together. The error has a fault and a next
  // step; the caller adds the picture's name.
  Expected<std::uint32_t> add(std::string name, std::span<const std::uint8_t> bytes,
                              std::uint64_t most_bytes);

  // Returns the pictures in the order of their indices.
  std::vector<EncodedPicture> take() { return std::move(pictures_); }

 private:
  using Place = std::pair<const std::uint8_t*, std::size_t>;

  std::vector<EncodedPicture> pictures_;
  std::map<Place, std::uint32_t> by_place_;
  std::map<Sha256, std::uint32_t> by_contents_;
  // total size of all different spans; its limit also bounds the time for hashing
  std::uint64_t bytes_ = 0;
};

}  // namespace vitrine::inline codec
