// SPDX-License-Identifier: Apache-2.0
// Reads the files that `codec/export` writes, including formats that Vitrine does not import.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/export/write_mesh.h"

namespace vitrine::test {

// Returns the positions and faces. Throws std::runtime_error if the file does not have that format.
// A 3MF file, which has z up, is turned so that y points up.
TriangleMesh read_export(std::span<const std::uint8_t> file, MeshFormat format);

// Returns the numbers between `[` and `]` after a keyword of a VRML file.
std::vector<double> vrml_list(const std::string& text, const std::string& keyword);

// Returns the numbers of an array of a USD layer, such as "point3f[] points", without parentheses.
std::vector<double> usd_list(const std::string& layer, const std::string& declaration);

}  // namespace vitrine::test
