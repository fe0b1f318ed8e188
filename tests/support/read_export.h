// SPDX-License-Identifier: Apache-2.0
// Reads what `codec/export` writes, the formats included that Vitrine does not import.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/export/write_mesh.h"

namespace vitrine::test {

// Positions and faces. Throws std::runtime_error where the file is not of the format.
TriangleMesh read_export(std::span<const std::uint8_t> file, MeshFormat format);

// The numbers between `[` and `]` after a keyword of a VRML file.
std::vector<double> vrml_list(const std::string& text, const std::string& keyword);

}  // namespace vitrine::test
