// SPDX-License-Identifier: Apache-2.0
#include "codec/format/file_blocks.h"

namespace vitrine::inline codec {

bool is_intact_head(const Manifest& manifest, std::span<const std::uint8_t> head) {
  if (head.size() != manifest.head_bytes()) return false;
  bool is_intact = true;
  for_each_block_beside_chunks(manifest, [&](const FileBlock& block) {
    if (block.offset >= head.size() || !is_intact) return;
    is_intact = sha256(head.subspan(block.offset, block.length)) == block.sha256;
  });
  return is_intact;
}

}  // namespace vitrine::inline codec
