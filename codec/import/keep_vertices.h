// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Removes the vertices that are not in `keep`, which no face may use, and renumbers the faces.
// `colours` may be empty. Returns how many were removed.
std::size_t keep_vertices(const std::vector<bool>& keep, std::vector<Vec3>& positions,
                          std::vector<Colour>& colours, std::span<Triangle> faces);

// Which of `count` vertices the faces use.
std::vector<bool> used_vertices(std::size_t count, std::span<const Triangle> faces);

}  // namespace vitrine
