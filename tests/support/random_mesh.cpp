// SPDX-License-Identifier: Apache-2.0
#include "support/random_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/core/limits.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

// A connected mesh with positions in about [-1, 1].
struct ComponentMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
};

Vec3 on_circle(std::uint32_t i, std::uint32_t n, double radius, double z) {
  // Uses a square instead of a circle. This needs no libm, so the result is the same on every
  // machine.
  const double t = 4.0 * i / n, f = t - std::floor(t);
  const int side = static_cast<int>(t);
  const double x[] = {1 - 2 * f, -1, -1 + 2 * f, 1}, y[] = {1, 1 - 2 * f, -1, -1 + 2 * f};
  return {radius * x[side], radius * y[side], z};
}

// Returns a cone over n rim vertices, with its apex at vertex 0. If `closed` is true, a second apex
// closes the cone.
ComponentMesh fan(std::uint32_t n, bool closed) {
  ComponentMesh part{.positions = {{0, 0, 0.5}}, .faces = {}};
  for (std::uint32_t i = 0; i < n; ++i)
    part.positions.push_back(on_circle(i, n, 1, 0));
  if (closed) part.positions.push_back({0, 0, -0.5});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % n;
    part.faces.push_back({0, a, b});
    if (closed) part.faces.push_back({n + 1, b, a});
  }
  return part;
}

ComponentMesh few_triangles(std::uint32_t count) {
  ComponentMesh part{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .faces = {{0, 1, 2}}};
  if (count > 1) part.positions.push_back({1, 1, 0.3}), part.faces.push_back({2, 1, 3});
  return part;
}

void add_quad(ComponentMesh& part, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  part.faces.push_back({a, b, c});
  part.faces.push_back({a, c, d});
}

// Returns a grid of u by v vertices. If one direction wraps, the grid is a tube. If both directions
// wrap, it is a torus.
ComponentMesh grid(std::uint32_t u, std::uint32_t v, bool wrap_u, bool wrap_v) {
  ComponentMesh part;
  for (std::uint32_t j = 0; j < v; ++j) {
    for (std::uint32_t i = 0; i < u; ++i) {
      const Vec3 across = on_circle(j, v, 0.3, 0);
      const Vec3 flat = {2.0 * i / u - 1, 2.0 * j / v - 1, 0.1 * ((i * j) % 3)};
      const double radius = 0.6 + (wrap_v ? across.x : 0);
      part.positions.push_back(wrap_u ? on_circle(i, u, radius, wrap_v ? across.y : flat.y) : flat);
    }
  }
  for (std::uint32_t j = 0; j + (wrap_v ? 0 : 1) < v; ++j) {
    for (std::uint32_t i = 0; i + (wrap_u ? 0 : 1) < u; ++i) {
      const std::uint32_t right = (i + 1) % u, up = (j + 1) % v;
      add_quad(part, j * u + i, j * u + right, up * u + right, up * u + i);
    }
  }
  return part;
}

// Returns a plate of u by v cells with a tunnel through each cell of odd row and column. Its genus
// is floor(u/2) * floor(v/2) for odd u and v.
ComponentMesh plate(std::uint32_t u, std::uint32_t v) {
  ComponentMesh part;
  const std::uint32_t layer = (u + 1) * (v + 1);
  for (std::uint32_t k = 0; k < 2 * layer; ++k) {
    const std::uint32_t i = k % layer % (u + 1), j = k % layer / (u + 1);
    part.positions.push_back({2.0 * i / u - 1, 2.0 * j / v - 1, k < layer ? 0.1 : -0.1});
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (u + 1) + i; };
  // An index below zero wraps to a large number, which counts as outside the plate.
  const auto solid = [&](std::uint32_t i, std::uint32_t j) {
    return i < u && j < v && !(i % 2 == 1 && j % 2 == 1);
  };
  // Adds the wall below the upper edge a -> b of a solid cell whose neighbour on that side is
  // empty.
  const auto wall = [&](std::uint32_t a, std::uint32_t b) {
    add_quad(part, a, a + layer, b + layer, b);
  };
  for (std::uint32_t j = 0; j < v; ++j) {
    for (std::uint32_t i = 0; i < u; ++i) {
      if (!solid(i, j)) continue;
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      add_quad(part, a, b, c, d);
      add_quad(part, d + layer, c + layer, b + layer, a + layer);
      if (!solid(i, j - 1)) wall(a, b);
      if (!solid(i + 1, j)) wall(b, c);
      if (!solid(i, j + 1)) wall(c, d);
      if (!solid(i - 1, j)) wall(d, a);
    }
  }
  return part;
}

ComponentMesh random_part(Dice& dice, std::uint32_t size) {
  const auto side = static_cast<std::int32_t>(std::max(4.0, std::sqrt(size)));
  const auto u = static_cast<std::uint32_t>(dice.between(3, side));
  const auto v = static_cast<std::uint32_t>(dice.between(3, side));
  switch (dice.below(10)) {
    case 0:
      return few_triangles(1);
    case 1:
      return few_triangles(2);
    case 2:
      return fan(3, true);
    case 3:
      return fan(static_cast<std::uint32_t>(dice.between(3, 70)), false);
    case 4:
      return fan(static_cast<std::uint32_t>(dice.between(3, 70)), true);
    case 5:
      return grid(u, v, true, false);
    case 6:
      return grid(u, v, true, true);
    case 7:
      return plate(u / 2 * 2 - 1, v / 2 * 2 + 1);
    default:
      return grid(u, v, false, false);
  }
}

// Inserts vertices into some faces. The valences become irregular, and many of them are 3.
void subdivide(Dice& dice, ComponentMesh& part) {
  const std::uint32_t count = dice.below(static_cast<std::uint32_t>(part.faces.size()) + 1) / 2;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t f = dice.below(static_cast<std::uint32_t>(part.faces.size()));
    const auto [a, b, c] = part.faces[f];
    const auto w = static_cast<std::uint32_t>(part.positions.size());
    part.positions.push_back((part.positions[a] + part.positions[b] + part.positions[c]) *
                             (1.0 / 3));
    part.faces[f] = {a, b, w};
    part.faces.push_back({b, c, w});
    part.faces.push_back({c, a, w});
  }
}

std::vector<bool> boundary_vertices(const ComponentMesh& part) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : part.faces) {
    for (std::size_t k = 0; k < 3; ++k)
      edges.emplace_back(t[k], t[(k + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<bool> boundary(part.positions.size(), false);
  for (const auto& [a, b] : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) {
      boundary[a] = boundary[b] = true;
    }
  }
  return boundary;
}

// Removes faces that share no vertex with each other or with a boundary.
void cut_holes(Dice& dice, ComponentMesh& part) {
  std::vector<bool> taken = boundary_vertices(part);
  std::vector<std::uint32_t> faces_of(part.positions.size(), 0);
  for (const Triangle& t : part.faces) {
    for (const std::uint32_t v : t)
      ++faces_of[v];
  }
  std::erase_if(part.faces, [&](const Triangle& t) {
    if (!dice.one_in(4)) return false;
    for (const std::uint32_t v : t) {
      if (taken[v] || faces_of[v] < 3) return false;
    }
    for (const std::uint32_t v : t)
      taken[v] = true;
    return true;
  });
}

// Shuffles the numbering of the vertices, so that no test depends on the order of construction.
void shuffle(Dice& dice, LatticeMesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<std::uint32_t> to(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    to[v] = v;
    std::swap(to[v], to[dice.below(v + 1)]);
  }
  std::vector<Vec3i> positions(n);
  for (std::uint32_t v = 0; v < n; ++v)
    positions[to[v]] = mesh.positions[v];
  mesh.positions = std::move(positions);
  for (Triangle& t : mesh.faces) {
    t = {to[t[0]], to[t[1]], to[t[2]]};
    std::rotate(t.begin(), t.begin() + dice.below(3), t.end());
  }
}

enum class PositionSpread { kSmooth, kNoisy, kCrowded, kCorners };

Vec3i place(Dice& dice, const Vec3& p, PositionSpread spread, std::int32_t top) {
  const auto random = [&](std::int32_t low, std::int32_t high) {
    return Vec3i{dice.between(low, high), dice.between(low, high), dice.between(low, high)};
  };
  if (spread == PositionSpread::kCrowded) return random(0, 2);
  if (spread == PositionSpread::kCorners) {
    const Vec3i bits = random(0, 1);
    return {bits.x * top, bits.y * top, bits.z * top};
  }
  const double half = 0.4 * top;
  const auto grid = [&](double c) {
    return static_cast<std::int32_t>(std::floor((c + 1.2) * half));
  };
  const Vec3i at = {grid(p.x), grid(p.y), grid(p.z)};
  const std::int32_t noise = spread == PositionSpread::kNoisy ? top / 20 : top / 400;
  const Vec3i moved = at + random(-noise, noise);
  return {std::clamp(moved.x, 0, top), std::clamp(moved.y, 0, top), std::clamp(moved.z, 0, top)};
}

void colour(Dice& dice, LatticeMesh& mesh) {
  const bool smooth = dice.one_in(2);
  const int shift = mesh.lattice.bits - 8;
  for (const Vec3i& p : mesh.positions) {
    const auto byte = [&](std::int32_t c) {
      return static_cast<std::uint8_t>(smooth ? c >> shift : dice.between(0, 255));
    };
    mesh.attributes.colours.push_back({byte(p.x), byte(p.y), byte(p.z)});
  }
}

ComponentMesh random_speck(Dice& dice) {
  switch (dice.below(8)) {
    case 0:
      return few_triangles(1);
    case 1:
      return few_triangles(2);
    case 2:
      return fan(static_cast<std::uint32_t>(dice.between(3, 9)), false);
    case 3:
      return fan(static_cast<std::uint32_t>(dice.between(4, 9)), true);
    case 4:
      return grid(3, static_cast<std::uint32_t>(dice.between(2, 5)), true, false);
    case 5:
      return grid(3, static_cast<std::uint32_t>(dice.between(3, 5)), true, true);
    default:
      return fan(3, true);
  }
}

}  // namespace

void add_specks(LatticeMesh& mesh, std::uint32_t count, std::uint64_t seed) {
  Dice dice(seed);
  const std::int32_t top = (1 << mesh.lattice.bits) - 1;
  const bool coloured = !mesh.attributes.colours.empty();
  for (std::uint32_t k = 0; k < count; ++k) {
    const ComponentMesh part = random_speck(dice);
    const std::int32_t half = dice.between(top / 400 + 1, top / 40);
    const Vec3i middle = {dice.between(half, top - half), dice.between(half, top - half),
                          dice.between(half, top - half)};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto grid = [&](double c) { return static_cast<std::int32_t>(std::floor(c * half)); };
    for (const Vec3& p : part.positions) {
      mesh.positions.push_back(middle + Vec3i{grid(p.x), grid(p.y), grid(p.z)});
      if (coloured) mesh.attributes.colours.push_back({static_cast<std::uint8_t>(k), 90, 17});
    }
    for (const auto& [a, b, c] : part.faces)
      mesh.faces.push_back({first + a, first + b, first + c});
  }
}

LatticeMesh random_mesh(std::uint64_t seed, std::uint32_t size) {
  Dice dice(seed);
  LatticeMesh mesh;
  mesh.lattice.bits = dice.between(kMinBits, kMaxBits);
  const std::int32_t top = (1 << mesh.lattice.bits) - 1;
  const std::uint32_t parts = dice.one_in(3) ? 1 + dice.below(4) : 1;
  for (std::uint32_t k = 0; k < parts; ++k) {
    ComponentMesh part = random_part(dice, size);
    if (dice.one_in(2)) subdivide(dice, part);
    if (dice.one_in(3)) cut_holes(dice, part);
    constexpr std::array kSpreads = {PositionSpread::kSmooth, PositionSpread::kSmooth,
                                     PositionSpread::kSmooth, PositionSpread::kNoisy,
                                     PositionSpread::kNoisy,  PositionSpread::kCrowded,
                                     PositionSpread::kCorners};
    const PositionSpread spread = kSpreads[dice.below(kSpreads.size())];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : part.positions)
      mesh.positions.push_back(place(dice, p, spread, top));
    for (const auto& [a, b, c] : part.faces)
      mesh.faces.push_back({first + a, first + b, first + c});
  }
  shuffle(dice, mesh);
  if (dice.one_in(3)) colour(dice, mesh);
  return mesh;
}

}  // namespace vitrine::test
