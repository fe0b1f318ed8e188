// SPDX-License-Identifier: Apache-2.0
// The surface that a mesh file or a .pmesh file holds.
#pragma once

#include <string>
#include <string_view>

#include "codec/import/read_mesh.h"
#include "codec/mesh/triangle_mesh.h"
#include "server/cli/input.h"

namespace vitrine::cli {

struct Surface {
  TriangleMesh mesh;
  std::string unit;  // empty where it is unknown
};

// Of a .pmesh the finest level; `reading` is for mesh files. For untrusted bytes, but in the
// sandbox.
Expected<Surface> read_surface(const InputFile& file, const std::string& name,
                               const ReadOptions& reading = {});

// Only where both units are known: otherwise the numbers stay as they are.
void convert(Surface& surface, std::string_view unit);

}  // namespace vitrine::cli
