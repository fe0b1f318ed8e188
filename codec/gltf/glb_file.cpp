// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/glb_file.h"

#include <algorithm>

#include "codec/core/byte_cursor.h"
#include "codec/gltf/gltf_document.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

Unexpected cut_short(std::string what) {
  return bad_input("GLB: " + std::move(what) + "; it is cut short, copy it again");
}

// Returns the length that the header states.
Expected<std::size_t> stated_length(std::span<const std::uint8_t> bytes) {
  ByteReader cursor(bytes);
  cursor.skip(4);
  const auto version = cursor.read<std::uint32_t>();
  const auto length = cursor.read<std::uint32_t>();
  if (!cursor.is_ok()) return cut_short("the file ends within its header");
  if (version != 2) {
    return fail(ErrorCode::kUnsupported,
                "GLB version " + std::to_string(version) + " is not read; export glTF 2.0");
  }
  return length;
}

// The start of a chunk: its position in the file, the number of bytes after its header, and its
// type.
struct ChunkHeader {
  std::size_t at;
  std::uint32_t size, type;

  bool is_known() const { return type == kJsonChunk || type == kBinaryChunk; }
};

ChunkHeader header_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return {at, load<std::uint32_t>(&bytes[at]), load<std::uint32_t>(&bytes[at + 4])};
}

// Returns the chunk that starts at byte `at`. If only the next multiple of 4 is the start of a
// chunk of a known type, returns that chunk instead: some exporters do not count the padding of a
// chunk.
ChunkHeader next_header(std::span<const std::uint8_t> bytes, std::size_t at) {
  const ChunkHeader found = header_at(bytes, at);
  const std::size_t padded = (at + 3) / 4 * 4;
  if (found.is_known() || padded + 8 > bytes.size()) return found;
  const ChunkHeader next = header_at(bytes, padded);
  return next.is_known() ? next : found;
}

}  // namespace

Expected<GlbChunks> split_glb(std::span<const std::uint8_t> bytes) {
  // Some exporters count up to this number of padding bytes at the file's end without writing them.
  constexpr std::size_t kMostPadding = 3;
  const auto length = stated_length(bytes);
  if (!length) return tl::unexpected(length.error());
  GlbChunks chunks;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const ChunkHeader header = next_header(bytes, at);
    // Ignores bytes after the stated length, unless they are a chunk of a known type.
    if (at >= *length && !header.is_known()) break;
    const std::size_t begin = header.at + 8, left = bytes.size() - begin;
    if (header.size > left + kMostPadding)
      return cut_short("a chunk of " + counted(header.size, "byte") + " ends beyond the file's " +
                       std::to_string(bytes.size()));
    const auto chunk = bytes.subspan(begin, std::min<std::size_t>(header.size, left));
    if (header.type == kJsonChunk && chunks.json.empty())
      chunks.json = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
    if (header.type == kBinaryChunk && chunks.binary.empty()) chunks.binary = chunk;
    at = begin + chunk.size();
  }
  if (*length > bytes.size() + kMostPadding && chunks.binary.empty()) {
    return cut_short("the header claims " + counted(*length, "byte") + ", the file has " +
                     std::to_string(bytes.size()));
  }
  return chunks;
}

}  // namespace vitrine::inline codec
