// SPDX-License-Identifier: Apache-2.0
#include "codec/format/lattice_attributes.h"

#include <utility>

namespace vitrine::inline codec {
namespace {

Vec3i to_lattice(const Colour& colour) {
  return to_ycocg(colour);
}

}  // namespace

LatticeAttributes lattice_attributes(const VertexAttributes& attributes) {
  LatticeAttributes out;
  attributes.for_each([&](Semantic semantic, const auto& column) {
    std::vector<Vec3i> values;
    values.reserve(column.size());
    for (const auto& value : column)
      values.push_back(to_lattice(value));
    out.push_back({semantic, std::move(values)});
  });
  return out;
}

}  // namespace vitrine::inline codec
