// SPDX-License-Identifier: Apache-2.0
// Reads hostile base meshes. The model has the numbers of vertices and faces that the Draco buffer
// states. If the buffer holds a valid mesh, the Draco library must read the same mesh from it.
#include <vector>

#include "../bounded.h"
#include "../checks.h"
#include "codec/base/base_decoder.h"
#include "codec/core/byte_cursor.h"
#include "codec/mesh/connectivity.h"
#include "support/library_base.h"

namespace vitrine {
namespace {

using fuzz::require;

constexpr std::size_t kCounts = 12;  // position of the numbers of vertices and faces in the buffer

Manifest stated_counts(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  in.skip(kCounts);
  Manifest manifest;
  LevelInfo level;
  level.vertices = static_cast<std::uint32_t>(in.varint());
  level.faces = static_cast<std::uint32_t>(in.varint());
  manifest.levels = {level};
  if (in.u8() != 0) manifest.attributes.push_back(Semantic::kColour);
  return manifest;
}

bool is_valid(const BaseMesh& mesh) {
  return Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces)
      .has_value();
}

void check(const BaseMesh& mesh, const Manifest& manifest, std::span<const std::uint8_t> bytes) {
  const LevelInfo& level = manifest.levels[0];
  require(mesh.positions.size() == level.vertices && mesh.faces.size() == level.faces);
  require(has_all(mesh.attributes, manifest.attributes, level.vertices));
  for (const Triangle& face : mesh.faces)
    require(std::ranges::all_of(face, [&](VertexId v) { return v < level.vertices; }));
  if (!is_valid(mesh)) return;
  const auto peer = test::library_base(bytes, manifest.attributes);
  require(peer && peer->positions == mesh.positions && peer->faces == mesh.faces);
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i)
    require(peer->attributes[i].values == mesh.attributes[i].values);
}

}  // namespace
}  // namespace vitrine

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const auto manifest = vitrine::stated_counts(bytes);
  vitrine::Expected<vitrine::BaseMesh> mesh;
  vitrine::fuzz::bounded(vitrine::test::kBaseHeap, size,
                         [&] { mesh = vitrine::decode_base(bytes, manifest); });
  if (mesh) vitrine::check(*mesh, manifest, bytes);
  return 0;
}
