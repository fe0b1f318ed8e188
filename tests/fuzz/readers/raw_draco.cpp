// SPDX-License-Identifier: Apache-2.0
// Replaces Draco, which is not safe on hostile bytes and is not fuzzed here. The first byte of the
// data is the number of faces. The faces' corners follow, one byte each. Every attribute has all
// remaining bytes as its values.
#include "codec/gltf/draco_primitive.h"

namespace vitrine::inline codec {

std::uint64_t DracoPrimitive::bytes() const {
  return faces.size() * sizeof(Triangle);
}

Expected<DracoPrimitive> decode_draco_primitive(std::span<const std::uint8_t> compressed,
                                                const Json&, const Json& primitive, const Limits&) {
  DracoPrimitive out;
  std::size_t at = 1;
  for (std::size_t f = 0; !compressed.empty() && f < compressed[0]; ++f, at += 3) {
    if (at + 3 > compressed.size()) return fail(ErrorCode::kBadInput, "the raw data is cut short");
    out.faces.push_back({compressed[at], compressed[at + 1], compressed[at + 2]});
  }
  if (compressed.size() <= at) return fail(ErrorCode::kBadInput, "the raw data is cut short");
  const auto values = compressed.subspan(at);
  for (const char* name : {"POSITION", "COLOR_0", "TEXCOORD_0"}) {
    if (whole(member(primitive, "attributes"), name, kAbsent) == kAbsent) continue;
    out.values[name].assign(values.begin(), values.end());
  }
  return out;
}

}  // namespace vitrine::inline codec
