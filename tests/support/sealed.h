// SPDX-License-Identifier: Apache-2.0
// Corrects the hash at the end of a changed header, so that a test reaches the code behind the hash
// check.
#pragma once

#include <algorithm>
#include <vector>

#include "codec/core/sha256.h"
#include "codec/format/manifest.h"

namespace vitrine::test {

// Returns the file with a correct hash. If the bytes do not begin with a header, returns them
// unchanged.
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
