// SPDX-License-Identifier: Apache-2.0
// Provides the buffer views of a glTF file, decompressed if necessary.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "codec/gltf/gltf_json.h"
#include "codec/gltf/gltf_resources.h"

namespace vitrine::inline codec {

struct BufferView {
  std::span<const std::uint8_t> bytes;
  // bytes between the starts of successive elements; 0 if they are contiguous
  std::uint64_t stride = 0;
};

class GltfBuffer {
 public:
  // `binary` is the binary chunk of a GLB file. It serves as buffer 0 if buffer 0 has no URI. All
  // arguments must outlive this object.
  GltfBuffer(const Json& document, std::span<const std::uint8_t> binary, GltfResources& resources)
      : document_(document), binary_(binary), resources_(resources) {}

  // Returns the buffer view number `index`. If the view extends beyond its buffer, returns the part
  // that is inside. Fails if it begins beyond. The bytes are valid as long as this object.
  Expected<BufferView> view(std::uint64_t index);

  // Adds `bytes` to the total size of decompressed data. Fails (kLimit) if this total exceeds 1024
  // times the size of the file and its companions.
  Expected<void> spend(std::uint64_t bytes);

  // Returns the number of views that extended beyond their buffer.
  std::uint64_t clipped() const { return clipped_.size(); }

  // Returns the total size in bytes of the file, its companions and the decompressed data.
  std::uint64_t bytes() const { return resources_.bytes() + spent_; }

 private:
  Expected<std::span<const std::uint8_t>> part(const Json& place, std::uint64_t index);
  Expected<std::span<const std::uint8_t>> buffer(std::uint64_t number);
  Expected<BufferView> decompressed(const Json& extension, std::uint64_t index);

  const Json& document_;
  std::span<const std::uint8_t> binary_;
  GltfResources& resources_;
  // Index of a buffer with a URI -> the buffer's bytes, or the error if they cannot be found. Each
  // URI is thus looked up only once.
  std::map<std::uint64_t, Expected<std::span<const std::uint8_t>>> buffers_;
  // index of a compressed buffer view -> its decompressed bytes
  std::map<std::uint64_t, std::vector<std::uint8_t>> decompressed_;
  std::set<std::uint64_t> clipped_;  // indices of the buffer views that were clipped
  std::uint64_t spent_ = 0;
};

}  // namespace vitrine::inline codec
