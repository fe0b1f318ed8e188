// SPDX-License-Identifier: Apache-2.0
// Makes random texture coordinates for a base mesh. The same seed gives the same atlas on every
// machine.
#pragma once

#include <cstdint>

#include "codec/format/base_mesh.h"

namespace vitrine::test {

// Divides the faces of `base` into one to six charts, and cuts some edges inside charts. In most
// atlases, the texture coordinates of a wedge are x and y of its vertex, moved by a random offset
// for each chart. Some atlases have random coordinates instead, so many faces are turned over or
// have no area. Wedges are numbered as decode_atlas() numbers them.
BaseAtlas random_atlas(const BaseMesh& base, std::uint64_t seed);

}  // namespace vitrine::test
