// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {

// Returns the PLY file of a wavy torus of about `faces` triangles. If `open` is true, the last ring
// is missing.
std::string bumpy_ply(int faces, bool open, bool coloured) {
  const int n = std::max(4, static_cast<int>(std::sqrt(faces / 2.0)));
  const int rings = open ? n - 1 : n;
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\n{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      n * n, coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "",
      2 * n * rings);
  const double step = 2 * std::acos(-1.0) / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = i * step, v = j * step, r = 1 + 0.2 * std::sin(5 * u) * std::cos(3 * v);
      text += fmt::format("{:.6f} {:.6f} {:.6f}", (3 + r * std::cos(v)) * std::cos(u),
                          (3 + r * std::cos(v)) * std::sin(u), r * std::sin(v));
      text += coloured ? fmt::format(" {} {} {}\n", i * 255 / n, j * 255 / n, (i + j) % 256) : "\n";
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * n + j, b = (i + 1) % n * n + j;
      const int c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
      text += fmt::format("3 {} {} {}\n3 {} {} {}\n", a, b, c, a, c, d);
    }
  }
  return text;
}

}  // namespace vitrine::test
