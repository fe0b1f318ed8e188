// SPDX-License-Identifier: Apache-2.0
// Makes a .pmesh file whose container is valid. Its base mesh, chunk, atlas and pictures are plain
// text, which no test decodes.
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

// If `pictures` is not empty, the model has a texture. Its atlas is the text "the atlas", and its
// first picture is in the file's head.
inline TinyPmesh tiny_pmesh(std::string_view base_text, std::string_view chunk_text,
                            const std::vector<std::string_view>& pictures = {}) {
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
  const auto atlas = to_bytes(pictures.empty() ? "" : "the atlas");
  if (!pictures.empty())
    m.texture = {.side = 4096, .atlas_length = atlas.size(), .atlas_sha256 = sha256(atlas)};
  for (const std::string_view text : pictures) {
    m.texture.pictures.push_back(
        {.side = 256, .length = text.size(), .sha256 = sha256(to_bytes(text))});
    m.texture.in_head = 1;
  }
  result.bytes = write_header(m);
  const auto append = [&](std::string_view text) {
    result.bytes.insert(result.bytes.end(), text.begin(), text.end());
  };
  append(base_text);
  append({reinterpret_cast<const char*>(atlas.data()), atlas.size()});
  for (std::size_t i = 0; i < m.texture.in_head; ++i)
    append(pictures[i]);
  append(chunk_text);
  for (std::size_t i = m.texture.in_head; i < pictures.size(); ++i)
    append(pictures[i]);
  return result;
}

}  // namespace vitrine::test
