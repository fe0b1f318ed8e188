// SPDX-License-Identifier: Apache-2.0
// The blocks of a `.pmesh` file: its base mesh, the atlas and the pictures of its texture, its
// chunks, and its optional blocks. The header states the SHA-256 of each block. Clients request
// blocks by this hash.
#pragma once

#include "codec/format/manifest.h"

namespace vitrine::inline codec {

struct FileBlock {
  Sha256 sha256{};
  std::uint64_t offset = 0, length = 0;  // in bytes; the offset is from the start of the file
};

// Calls visit(FileBlock) for the base mesh, the atlas, each picture and each optional block. There
// are at most kMaxPictures + kMaxOptionalBlocks + 2 such blocks.
template <class Visit>
void for_each_block_beside_chunks(const Manifest& manifest, Visit visit) {
  visit(FileBlock{manifest.base_sha256, manifest.base_offset, manifest.base_length});
  for (const OptionalBlock& block : manifest.optional_blocks)
    visit(FileBlock{block.sha256, block.offset, block.length});
  const TextureInfo& texture = manifest.texture;
  if (texture.empty()) return;
  visit(FileBlock{texture.atlas_sha256, texture.atlas_offset, texture.atlas_length});
  for (const PictureInfo& picture : texture.pictures)
    visit(FileBlock{picture.sha256, picture.offset, picture.length});
}

// Calls visit(FileBlock) for each block.
template <class Visit>
void for_each_block(const Manifest& manifest, Visit visit) {
  for_each_block_beside_chunks(manifest, visit);
  for (const ChunkInfo& chunk : manifest.chunks)
    visit(FileBlock{chunk.sha256, chunk.offset, chunk.length});
}

// Whether every block in `head` has the SHA-256 that `manifest` states. `head` holds the first
// Manifest::head_bytes() bytes of a file.
bool is_intact_head(const Manifest& manifest, std::span<const std::uint8_t> head);

}  // namespace vitrine::inline codec
