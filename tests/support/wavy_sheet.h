// SPDX-License-Identifier: Apache-2.0
// A mesh with a curved surface and any number of vertices, as an OBJ file.
#pragma once

#include <array>
#include <cmath>
#include <string>

namespace vitrine::test {

// Returns a wavy sheet as OBJ, with side * side vertices and 2 * (side - 1) * (side - 1) triangles.
inline std::string wavy_sheet(int side) {
  std::string text;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(std::sin(0.3 * x) * std::cos(0.2 * y)) + "\n";
    }
  }
  for (int y = 0; y + 1 < side; ++y) {
    for (int x = 0; x + 1 < side; ++x) {
      const int a = y * side + x + 1, b = a + 1, c = a + side, d = c + 1;
      for (const auto& [p, q, r] : {std::array{a, b, d}, std::array{a, d, c}}) {
        text += "f " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
      }
    }
  }
  return text;
}

}  // namespace vitrine::test
