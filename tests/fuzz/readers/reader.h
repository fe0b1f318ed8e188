// SPDX-License-Identifier: Apache-2.0
// Checks that the fuzzers of all readers use. For any bytes, a reader must return a mesh that can
// be repaired, or an error of one line.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "codec/import/readers.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/unit.h"
#include "codec/repair/raw_mesh.h"
#include "codec/repair/repair.h"
#include "fuzz/bounded.h"
#include "fuzz/checks.h"

namespace vitrine::fuzz {

inline void check_texturing(const Texturing& texturing, std::size_t faces) {
  const auto has_one_per_face = [&](const auto& column) { return column.size() == faces; };
  require(texturing.empty() || has_one_per_face(texturing.face_materials));
  for (const std::uint16_t material : texturing.face_materials)
    require(material < texturing.materials.size());
  for (const auto& set : texturing.coordinates) {
    require(set.empty() || has_one_per_face(set));
    for (const auto& face : set) {
      for (const auto& [u, v] : face)
        require(std::isfinite(u) && std::isfinite(v));
    }
  }
  for (const Material& material : texturing.materials) {
    for_each_map(material, [&](const TextureMap& map) {
      require(map.picture < texturing.pictures.size());
      require(has_one_per_face(texturing.coordinates.at(map.coordinates)));
    });
  }
}

inline void check_repaired(ImportedMesh imported) {
  const TriangleMesh before = imported.mesh;
  require(before.attributes.fit(before.positions.size()));
  check_texturing(imported.texturing, before.faces.size());
  const auto repaired = repair(std::move(imported));
  if (!repaired) return;
  const TriangleMesh& mesh = repaired->mesh;
  require(mesh.faces.size() <= before.faces.size());
  check_texturing(repaired->texturing, mesh.faces.size());
  require(mesh.attributes.fit(mesh.positions.size()));
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  require(Connectivity::close(count, mesh.faces).has_value());
}

// Completes the mesh of a text format. Checks that a unit stated in a comment is a known unit.
inline Expected<ImportedMesh> finished(std::span<const std::uint8_t> bytes, Expected<RawMesh> raw) {
  const std::string_view unit = unit_in_comments(bytes);
  require(unit.empty() || metres_per(unit));
  if (!raw) return tl::unexpected(raw.error());
  return std::move(*raw).finish({});
}

// Calls `read`, which converts the bytes to an ImportedMesh. Checks the memory that `read` uses,
// and the mesh or error that it returns. Ignores inputs of more than 64 KiB.
template <class Read>
int check(std::span<const std::uint8_t> bytes, const test::HeapBound& heap, Read&& read) {
  if (bytes.size() > 1 << 16) return 0;
  Expected<ImportedMesh> imported;
  bounded(heap, bytes.size(), [&] { imported = read(bytes); });
  if (imported)
    check_repaired(*std::move(imported));
  else
    require(imported.error().message.find('\n') == std::string::npos);
  return 0;
}

}  // namespace vitrine::fuzz
