// SPDX-License-Identifier: Apache-2.0
// Makes random manifold meshes on the lattice. The same seed gives the same mesh on every machine.
#pragma once

#include <cstdint>
#include <random>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::test {

// Random numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  std::int32_t between(std::int32_t low, std::int32_t high) {  // both bounds are included
    return low + static_cast<std::int32_t>(below(static_cast<std::uint32_t>(high - low + 1)));
  }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

// Combines one to four components: single triangles, pairs, tetrahedra, fans and bipyramids of any
// valence, sheets, tubes, tori, and plates of high genus. Then inserts vertices into faces and cuts
// holes. Colours are optional. Positions are smooth, noisy, crowded onto few lattice points, or at
// the lattice's corners. Connectivity::close accepts the faces. Each component has about `size`
// vertices at most.
LatticeMesh random_mesh(std::uint64_t seed, std::uint32_t size = 120);

// Adds `count` small components at random places of the lattice: triangles, pairs, tetrahedra,
// bipyramids, fans, small tubes and rings. Each is about 1/200 to 1/20 of the lattice wide, and
// coloured if the mesh is.
void add_specks(LatticeMesh& mesh, std::uint32_t count, std::uint64_t seed);

}  // namespace vitrine::test
