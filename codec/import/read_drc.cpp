// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_drc.h"

#include <draco/mesh/mesh.h>

#include <array>
#include <string_view>

#include "codec/gltf/draco_data.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

bool read_positions(const draco::Mesh& mesh, std::vector<Vec3>& out) {
  const auto* attribute = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (attribute == nullptr || attribute->num_components() != 3) return false;
  out.reserve(mesh.num_points());
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    const auto at = attribute->mapped_index(draco::PointIndex(p));
    std::array<double, 3> value{};
    if (at.value() >= attribute->size() || !attribute->ConvertValue<double>(at, 3, value.data()))
      return false;
    out.push_back({value[0], value[1], value[2]});
  }
  return true;
}

}  // namespace

bool is_drc(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kMagic = "DRACO";
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

Expected<TriangleMesh> read_drc(std::span<const std::uint8_t> bytes, const Limits& limits) {
  const auto decoded = decode_draco_data(bytes, limits);
  if (!decoded) return tl::unexpected(decoded.error());
  RawMesh raw;
  if (!read_positions(**decoded, raw.positions))
    return bad_input("the Draco data has no positions in space; export it again");
  for (const Triangle& face : faces_of(**decoded))
    raw.add_triangle(face);
  return std::move(raw).finish(limits).map(
      [](ImportedMesh&& imported) { return std::move(imported.mesh); });
}

}  // namespace vitrine::inline codec
