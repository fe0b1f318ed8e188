// SPDX-License-Identifier: Apache-2.0
// What every reader must keep on any bytes: an error of one line, or a mesh that repair makes sound
// without losing a face.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "codec/import/raw_mesh.h"
#include "codec/import/readers.h"
#include "codec/import/repair.h"
#include "codec/import/unit_comment.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/unit.h"
#include "fuzz/bounded.h"
#include "fuzz/checks.h"

namespace vitrine::fuzz {

inline void check_repaired(ImportedMesh imported) {
  const TriangleMesh before = imported.mesh;
  require(before.colours.empty() || before.colours.size() == before.positions.size());
  const auto repaired = repair(std::move(imported));
  if (!repaired) return;
  const TriangleMesh& mesh = repaired->mesh;
  require(mesh.faces.size() <= before.faces.size());
  require(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size());
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  require(Connectivity::close(count, mesh.faces).has_value());
}

// For the readers of text, which may state a unit.
inline Expected<ImportedMesh> finished(std::span<const std::uint8_t> bytes, Expected<RawMesh> raw) {
  const std::string_view unit = unit_in_comments(bytes);
  require(unit.empty() || metres_per(unit));
  if (!raw) return Unexpected(raw.error());
  return std::move(*raw).finish({});
}

// `read` turns the bytes into an ImportedMesh, in memory that their number allows.
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
