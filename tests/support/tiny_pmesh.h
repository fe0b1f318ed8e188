// SPDX-License-Identifier: Apache-2.0
// Makes a .pmesh file whose container is valid. Its base mesh and chunk are plain text, which no
// test decodes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codec/format/manifest.h"

namespace vitrine::test {

struct TinyPmesh {
  Manifest manifest;
  std::vector<std::uint8_t> bytes;
};

inline std::vector<std::uint8_t> to_bytes(std::string_view text) {
  return {text.begin(), text.end()};
}

inline TinyPmesh tiny_pmesh(std::string_view base_text, std::string_view chunk_text) {
  const auto base = to_bytes(base_text), chunk = to_bytes(chunk_text);
  TinyPmesh result;
  Manifest& m = result.manifest;
  m.unit = "mm";
  m.tree.nodes[0].box.high = {10, 20, 30};
  m.levels = {{.vertices = 4, .faces = 4, .max_error = 0.5, .rms_error = 0.25},
              {.vertices = 6, .faces = 8}};
  m.base_length = base.size();
  m.base_sha256 = sha256(base);
  m.chunks = {
      {.level = 1, .region = 0, .length = chunk.size(), .splits = 2, .sha256 = sha256(chunk)}};
  result.bytes = write_header(m);
  result.bytes.insert(result.bytes.end(), base.begin(), base.end());
  result.bytes.insert(result.bytes.end(), chunk.begin(), chunk.end());
  return result;
}

}  // namespace vitrine::test
