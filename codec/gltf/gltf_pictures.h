// SPDX-License-Identifier: Apache-2.0
// Finds the images of a glTF document, and records why some of them cannot be kept.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "codec/gltf/gltf_buffer.h"

namespace vitrine::inline codec {

class GltfPictures {
 public:
  // The arguments must outlive this object.
  GltfPictures(const Json& document, GltfBuffer& buffer, GltfResources& resources)
      : document_(document), buffer_(buffer), resources_(resources) {}

  // Returns the bytes of image number `index`, which are valid as long as the constructor's
  // arguments. If they cannot be read, the error (kBadInput or kLimit) states the reason and the
  // user's next step.
  Expected<std::span<const std::uint8_t>> bytes(std::uint64_t index);

  // Returns the name of image number `index` or of its file, or an empty string.
  std::string name(std::uint64_t index) const;

  std::uint64_t count() const;

  // Records why image number `index` cannot be kept. Later faults of the same image are ignored.
  void refuse(std::uint64_t index, std::string fault) { faults_.try_emplace(index, fault); }
  bool is_refused(std::uint64_t index) const { return faults_.contains(index); }
  std::size_t refused() const { return faults_.size(); }

  // Returns one line for each kind of fault of the refused images.
  std::vector<std::string> report() const;

 private:
  Expected<std::span<const std::uint8_t>> find(std::uint64_t index);

  const Json& document_;
  GltfBuffer& buffer_;
  GltfResources& resources_;
  // Index of an image -> its bytes. Each data: URI is thus decoded only once.
  std::map<std::uint64_t, std::span<const std::uint8_t>> found_;
  std::map<std::uint64_t, std::string> faults_;  // index of the image -> fault
};

}  // namespace vitrine::inline codec
