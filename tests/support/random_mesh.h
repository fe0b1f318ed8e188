// SPDX-License-Identifier: Apache-2.0
// Random manifold meshes on the lattice, the same for the same seed on every machine.
#pragma once

#include <cstdint>
#include <random>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::test {

// A source of random numbers whose results do not depend on the standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  std::int32_t between(std::int32_t low, std::int32_t high) {  // both included
    return low + static_cast<std::int32_t>(below(static_cast<std::uint32_t>(high - low + 1)));
  }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

// One to four components out of: single triangles, pairs, tetrahedra, fans and bipyramids of any
// valence, sheets, tubes, tori, plates of high genus; then vertices put into faces, holes cut,
// colours or none, positions smooth, noisy, crowded onto few lattice points or at its corners.
// Connectivity::close accepts the faces. At most about `size` vertices a component.
LatticeMesh random_mesh(std::uint64_t seed, std::uint32_t size = 120);

// Adds `count` small components all over the lattice: triangles, pairs, tetrahedra, bipyramids,
// fans, little tubes and rings, each about 1/200 to 1/20 of the lattice wide; coloured where the
// mesh is.
void add_specks(LatticeMesh& mesh, std::uint32_t count, std::uint64_t seed);

}  // namespace vitrine::test
