// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_buffer.h"

#include <algorithm>

#include "codec/gltf/meshopt_view.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint64_t kMostExpansionInAll = 1024;

std::string named(std::uint64_t index, const std::string& what) {
  return "glTF buffer view " + std::to_string(index) + ' ' + what +
         "; the file is damaged, export it again";
}

Unexpected bad_view(std::uint64_t index, const std::string& what) {
  return bad_input(named(index, what));
}

}  // namespace

Expected<BufferView> GltfBuffer::view(std::uint64_t index) {
  const Json& self = element(document_, "bufferViews", index);
  if (!self.is_object()) return bad_view(index, "does not exist");
  if (const Json& compression = extension(self, "EXT_meshopt_compression");
      compression.is_object()) {
    return decompressed(compression, index);
  }
  const auto bytes = part(self, index);
  if (!bytes) return tl::unexpected(bytes.error());
  return BufferView{*bytes, whole(self, "byteStride", 0)};
}

Expected<std::span<const std::uint8_t>> GltfBuffer::part(const Json& place, std::uint64_t index) {
  const std::uint64_t number = whole(place, "buffer", kAbsent);
  const bool has_uri = member(element(document_, "buffers", number), "uri").is_string();
  if (number != 0 && !has_uri) return bad_view(index, "is in a buffer without data");
  const auto bytes = has_uri ? buffer(number) : Expected<std::span<const std::uint8_t>>(binary_);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::uint64_t begin = whole(place, "byteOffset", 0), size = whole(place, "byteLength", 0);
  if (begin > bytes->size()) return bad_view(index, "lies beyond the end of its buffer");
  // Some exporters state views that are longer than the buffer, such as with padding that they do
  // not write. The readers of the view check that it holds all their data.
  const std::uint64_t present = std::min<std::uint64_t>(size, bytes->size() - begin);
  if (present < size) clipped_.insert(index);
  return bytes->subspan(begin, present);
}

// Returns the bytes of a buffer that has a URI.
Expected<std::span<const std::uint8_t>> GltfBuffer::buffer(std::uint64_t number) {
  if (const auto known = buffers_.find(number); known != buffers_.end()) return known->second;
  auto bytes = resources_.find(text(element(document_, "buffers", number), "uri", ""));
  if (!bytes)
    bytes = bad_input("glTF buffer " + std::to_string(number) + ' ' + bytes.error().message);
  return buffers_.emplace(number, std::move(bytes)).first->second;
}

Expected<BufferView> GltfBuffer::decompressed(const Json& extension, std::uint64_t index) {
  const std::uint64_t stride = whole(extension, "byteStride", 0);
  const auto [it, is_new] = decompressed_.try_emplace(index);
  if (is_new) {
    const auto bytes = part(extension, index);
    if (!bytes) return tl::unexpected(bytes.error());
    auto plain = decode_meshopt(extension, *bytes);
    if (!plain) return fail(plain.error().code, named(index, plain.error().message));
    if (auto ok = spend(plain->size()); !ok) return tl::unexpected(ok.error());
    it->second = *std::move(plain);
  }
  return BufferView{it->second, stride};
}

Expected<void> GltfBuffer::spend(std::uint64_t bytes) {
  spent_ += bytes;
  if (spent_ <= kMostExpansionInAll * resources_.bytes()) return {};
  return fail(ErrorCode::kLimit,
              "the glTF's compressed parts make too many bytes; export it without compression");
}

}  // namespace vitrine::inline codec
