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
#include "codec/core/limits.h"
#include "codec/core/sha256.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

class CarriedPictures {
 public:
  // Adds a picture and returns its index. If a picture with the same contents exists, returns that
  // picture's index. `bytes` must outlive this object.
  //
  // Keeps the bytes of PNG, JPEG and WebP files. Converts TIFF, BMP and TGA to PNG; all of them
  // together may have at most Limits::pixels pixels. Fails (kUnsupported, kBadInput) if the picture
  // has another format or cannot be converted. Fails (kLimit) if all added pictures have more than
  // `most_bytes` bytes together. A picture that is added again from the same span of bytes counts
  // only once. The error has a fault and a next step; the caller adds the picture's name.
  Expected<std::uint32_t> add(std::string name, std::span<const std::uint8_t> bytes,
                              std::uint64_t most_bytes);

  // Returns the pictures in the order of their indices.
  std::vector<EncodedPicture> take() { return std::move(pictures_); }

  // Returns a line for the user about the pictures that were converted to PNG, or no line.
  std::vector<std::string> report() const;

 private:
  // Returns the bytes of the picture's file, or of a PNG file with the same pixels.
  Expected<std::vector<std::uint8_t>> as_carried_format(std::span<const std::uint8_t> bytes);

  using SpanKey = std::pair<const std::uint8_t*, std::size_t>;

  std::vector<EncodedPicture> pictures_;
  std::map<SpanKey, std::uint32_t> by_span_;
  std::map<Sha256, std::uint32_t> by_contents_;
  // total size in bytes of the added pictures; its limit also bounds the time for hashing
  std::uint64_t bytes_ = 0;
  std::uint64_t pixels_left_ = Limits{}.pixels;  // pixels that may still be converted
  std::uint64_t converted_ = 0;
};

}  // namespace vitrine::inline codec
