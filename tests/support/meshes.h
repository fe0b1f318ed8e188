// SPDX-License-Identifier: Apache-2.0
// Makes small meshes for tests, and reads the meshes of tests/models.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "codec/import/read_mesh.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/repair/repair.h"

namespace vitrine::test {

// Returns the triangles of a grid of `u` by `v` vertices: two for each quad. `wrap_u` joins the
// last column of vertices to the first, and `wrap_v` the last row to the first.
inline std::vector<Triangle> grid_faces(std::uint32_t u, std::uint32_t v, bool wrap_u,
                                        bool wrap_v) {
  std::vector<Triangle> faces;
  for (std::uint32_t j = 0; j + (wrap_v ? 0 : 1) < v; ++j) {
    for (std::uint32_t i = 0; i + (wrap_u ? 0 : 1) < u; ++i) {
      const std::uint32_t right = (i + 1) % u, up = (j + 1) % v;
      const std::uint32_t a = j * u + i, b = j * u + right, c = up * u + right, d = up * u + i;
      faces.push_back({a, b, c});
      faces.push_back({a, c, d});
    }
  }
  return faces;
}

// Returns a wavy sheet with one boundary loop.
inline TriangleMesh sheet(std::uint32_t u, std::uint32_t v) {
  TriangleMesh mesh{.positions = {}, .faces = grid_faces(u, v, false, false), .attributes = {}};
  for (std::uint32_t j = 0; j < v; ++j) {
    for (std::uint32_t i = 0; i < u; ++i) {
      mesh.positions.push_back({1.0 * i, 1.0 * j, 2 * std::sin(0.4 * i) * std::cos(0.3 * j)});
    }
  }
  return mesh;
}

// Returns a cylinder that is open at both ends, so it has two boundary loops.
inline TriangleMesh tube(std::uint32_t around, std::uint32_t along) {
  TriangleMesh mesh{
      .positions = {}, .faces = grid_faces(around, along, true, false), .attributes = {}};
  for (std::uint32_t j = 0; j < along; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.positions.push_back({10 * std::cos(angle), 10 * std::sin(angle), 1.0 * j});
    }
  }
  return mesh;
}

// Returns a torus, which is closed and has genus 1.
inline TriangleMesh torus(std::uint32_t around, std::uint32_t across) {
  TriangleMesh mesh{
      .positions = {}, .faces = grid_faces(around, across, true, true), .attributes = {}};
  for (std::uint32_t j = 0; j < across; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = 10 + 3 * std::cos(b);
      mesh.positions.push_back({r * std::cos(a), r * std::sin(a), 3 * std::sin(b)});
    }
  }
  return mesh;
}

inline std::vector<std::uint8_t> file_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Returns a mesh of tests/models after repair.
inline TriangleMesh shipped_model(const std::string& name) {
  auto imported = read_mesh(file_bytes(VITRINE_SOURCE_DIR "/tests/models/" + name));
  if (!imported) throw std::runtime_error(imported.error().message);
  auto repaired = repair(std::move(*imported));
  if (!repaired) throw std::runtime_error(repaired.error().message);
  return std::move(repaired->mesh);
}

// Returns the faces, each rotated to start at its smallest vertex, in ascending order. Equal
// surfaces give equal results.
inline std::vector<Triangle> canonical(std::vector<Triangle> faces) {
  for (Triangle& f : faces)
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace vitrine::test
