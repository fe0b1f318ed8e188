// SPDX-License-Identifier: Apache-2.0
// The bound of the heap memory for decoding a hostile `.pmesh`.
#pragma once

#include <cstdint>
#include <span>

#include "codec/format/manifest.h"
#include "support/heap_bound.h"

namespace vitrine::fuzz {

inline const test::HeapBound& decoding_bound(std::span<const std::uint8_t> pmesh) {
  const auto manifest = parse_header(pmesh);
  const bool is_textured = manifest && !manifest->texture.empty();
  return is_textured ? test::kDecodingTextureHeap : test::kDecodingHeap;
}

}  // namespace vitrine::fuzz
