// SPDX-License-Identifier: Apache-2.0
// Reads hostile atlases (coded texture coordinates) of small base meshes. The first byte chooses
// the mesh, the other bytes are the atlas. An atlas that is accepted must encode to bytes that
// decode to the same atlas.
#include "../checks.h"
#include "codec/coding/atlas_coder.h"
#include "codec/coding/wedges.h"

namespace vitrine {
namespace {

using fuzz::require;

// Returns a strip of `count` triangles, or a fan whose first and last triangle may be neighbours.
BaseMesh small_mesh(std::uint8_t choice) {
  const std::uint32_t count = 1 + choice % 32;
  const bool is_fan = (choice & 0x40) != 0, is_closed = is_fan && (choice & 0x20) != 0 && count > 2;
  BaseMesh base;
  base.positions.resize(is_closed ? count + 1 : count + 2);
  for (std::uint32_t f = 0; f < count; ++f) {
    const std::uint32_t next = is_closed && f + 1 == count ? 1 : f + 2;
    if (is_fan) {
      base.faces.push_back({0, f + 1, next});
    } else {
      base.faces.push_back(f % 2 == 0 ? Triangle{f, f + 1, f + 2} : Triangle{f + 1, f, f + 2});
    }
  }
  return base;
}

void check(const BaseMesh& base) {
  const auto mesh =
      Connectivity::close(static_cast<std::uint32_t>(base.positions.size()), base.faces);
  require(mesh && Wedges::from_base(base.atlas, *mesh));
  BaseMesh plain = base;
  plain.atlas = {};
  const auto again = decode_atlas(encode_atlas(base), plain);
  require(again && again->wedges == base.atlas.wedges &&
          again->coordinates == base.atlas.coordinates);
}

}  // namespace
}  // namespace vitrine

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  vitrine::BaseMesh base = vitrine::small_mesh(data[0]);
  auto atlas = vitrine::decode_atlas({data + 1, size - 1}, base);
  if (!atlas) return 0;
  base.atlas = std::move(*atlas);
  vitrine::check(base);
  return 0;
}
