// SPDX-License-Identifier: Apache-2.0
// Makes the hash at the end of a changed header true, so that a test reaches what is behind it.
#pragma once

#include <algorithm>
#include <vector>

#include "codec/core/sha256.h"
#include "codec/progressive/manifest.h"

namespace vitrine::test {

// The bytes as they are where they do not begin with a header.
inline std::vector<std::uint8_t> sealed(std::span<const std::uint8_t> file) {
  std::vector<std::uint8_t> bytes(file.begin(), file.end());
  const auto length = header_bytes(file.first(std::min(file.size(), kHeaderPrefix)));
  if (!length || *length > bytes.size()) return bytes;
  const auto header = std::span(bytes).first(*length);
  const Sha256 hash = sha256(header.first(header.size() - sizeof hash));
  std::copy(hash.begin(), hash.end(), header.last(hash.size()).begin());
  return bytes;
}

}  // namespace vitrine::test
