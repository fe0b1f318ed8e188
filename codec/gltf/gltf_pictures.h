// SPDX-License-Identifier: Apache-2.0
// Finds the images of a glTF document, and remembers why some cannot be carried.
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

  // Returns the bytes of image `index`, which live as long as the arguments of the constructor.
  // Fails (kBadInput) with a fault and a next step.
  Expected<std::span<const std::uint8_t>> bytes(std::uint64_t index);

  // Returns the name of image `index` or of its file, or an empty text.
  std::string name(std::uint64_t index) const;

  std::uint64_t count() const;

  // Notes that image `index` cannot be carried. Only the first fault of an image counts.
  void refuse(std::uint64_t index, std::string fault) { faults_.try_emplace(index, fault); }
  bool is_refused(std::uint64_t index) const { return faults_.contains(index); }
  std::size_t refused() const { return faults_.size(); }

  // Reports the refused images, one line for each fault.
  std::vector<std::string> report() const;

 private:
  Expected<std::span<const std::uint8_t>> find(std::uint64_t index);

  const Json& document_;
  GltfBuffer& buffer_;
  GltfResources& resources_;
  // key: index of the image; data: URIs are decoded only once
  std::map<std::uint64_t, std::span<const std::uint8_t>> found_;
  std::map<std::uint64_t, std::string> faults_;  // key: index of the image
};

}  // namespace vitrine::inline codec
