// SPDX-License-Identifier: Apache-2.0
// The buffer views of a binary glTF file, decompressed where they are compressed.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "codec/import/gltf_json.h"

namespace vitrine {

struct BufferView {
  std::span<const std::uint8_t> bytes;
  std::uint64_t stride = 0;  // of its elements; 0 where they follow without gaps
};

class GltfBuffer {
 public:
  // `binary` is the file's binary chunk. Both must outlive this.
  GltfBuffer(const Json& document, std::span<const std::uint8_t> binary)
      : document_(document), binary_(binary) {}

  // Fails unless the view lies within the binary chunk. The bytes live as long as this.
  Expected<BufferView> view(std::uint64_t index);

  // Counts `bytes` as made by decompression; fails (kLimit) beyond 1024 times the binary chunk.
  Expected<void> spend(std::uint64_t bytes);
  std::uint64_t spent() const { return spent_; }

 private:
  Expected<std::span<const std::uint8_t>> part(const Json& place, std::uint64_t index) const;
  Expected<BufferView> decompressed(const Json& extension, std::uint64_t index);

  const Json& document_;
  std::span<const std::uint8_t> binary_;
  std::map<std::uint64_t, std::vector<std::uint8_t>> decompressed_;  // by view
  std::uint64_t spent_ = 0;
};

}  // namespace vitrine
