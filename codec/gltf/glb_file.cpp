// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/glb_file.h"

#include "codec/core/byte_cursor.h"
#include "codec/gltf/gltf_document.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

Unexpected cut_short(std::string what) {
  return bad_input("GLB: " + std::move(what) + "; it is cut short, copy it again");
}

Expected<std::size_t> checked_length(std::span<const std::uint8_t> bytes) {
  ByteReader cursor(bytes);
  cursor.skip(4);
  const auto version = cursor.read<std::uint32_t>();
  const auto length = cursor.read<std::uint32_t>();
  if (!cursor.is_ok()) return cut_short("the file ends within its header");
  if (version != 2) {
    return fail(ErrorCode::kUnsupported,
                "GLB version " + std::to_string(version) + " is not read; export glTF 2.0");
  }
  if (length > bytes.size()) {
    return cut_short("the header claims " + counted(length, "byte") + ", the file has " +
                     std::to_string(bytes.size()));
  }
  return length;
}

}  // namespace

Expected<GlbChunks> split_glb(std::span<const std::uint8_t> bytes) {
  const auto length = checked_length(bytes);
  if (!length) return tl::unexpected(length.error());
  GlbChunks chunks;
  for (std::size_t at = 12; at + 8 <= *length;) {
    const auto size = load<std::uint32_t>(&bytes[at]);
    const auto type = load<std::uint32_t>(&bytes[at + 4]);
    if (size > *length - at - 8) return bad_gltf("a chunk is cut short");
    const auto chunk = bytes.subspan(at + 8, size);
    if (type == kJsonChunk && chunks.json.empty()) {
      chunks.json = {reinterpret_cast<const char*>(chunk.data()), size};
    }
    if (type == kBinaryChunk && chunks.binary.empty()) chunks.binary = chunk;
    at += 8 + std::size_t{size};
  }
  return chunks;
}

}  // namespace vitrine::inline codec
