// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/draco_primitive.h"

#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "codec/gltf/draco_data.h"
#include "codec/gltf/gltf_accessor.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

Unexpected bad(const std::string& what) {
  return bad_input("glTF: the Draco data " + what + "; the file is damaged, export it again");
}

// Whether values of `stored` components can be read as values of `stated` components. Surplus
// components are dropped, as in other readers. Only the opacity of colours may be missing.
bool is_width_clear(std::string_view name, std::uint32_t stored, std::uint32_t stated) {
  return stored >= stated || (name == "COLOR_0" && stored == 3);
}

// Copies values of `width` components each. Missing components are opacities and become 1.
template <class T>
bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points, std::uint32_t width,
                 std::vector<std::uint8_t>& out) {
  constexpr T kOpaque = std::is_integral_v<T> ? std::numeric_limits<T>::max() : T{1};
  const auto stored = static_cast<std::uint32_t>(attribute.num_components());
  out.resize(std::size_t{points} * width * sizeof(T));
  std::vector<T> value(width);
  for (std::uint32_t p = 0; p < points; ++p) {
    const auto at = attribute.mapped_index(draco::PointIndex(p));
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(at, static_cast<std::int8_t>(width), value.data())) {
      return false;
    }
    if (stored < width) std::fill(value.begin() + stored, value.end(), kOpaque);
    std::memcpy(out.data() + std::size_t{p} * width * sizeof(T), value.data(), width * sizeof(T));
  }
  return true;
}

bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points,
                 const Accessor& shape, std::vector<std::uint8_t>& out) {
  switch (shape.type()) {
    case Accessor::kByte:
      return copy_values<std::int8_t>(attribute, points, shape.width(), out);
    case Accessor::kUbyte:
      return copy_values<std::uint8_t>(attribute, points, shape.width(), out);
    case Accessor::kShort:
      return copy_values<std::int16_t>(attribute, points, shape.width(), out);
    case Accessor::kUshort:
      return copy_values<std::uint16_t>(attribute, points, shape.width(), out);
    case Accessor::kUint:
      return copy_values<std::uint32_t>(attribute, points, shape.width(), out);
    case Accessor::kFloat:
      return copy_values<float>(attribute, points, shape.width(), out);
  }
  return false;
}

bool is_wanted(std::string_view name) {
  return name == "POSITION" || name == "COLOR_0" || name.starts_with("TEXCOORD_") ||
         name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

Expected<void> read_values(const draco::Mesh& mesh, const Json& document, const Json& primitive,
                           DracoPrimitive& out) {
  const Json& ids = member(extension(primitive, "KHR_draco_mesh_compression"), "attributes");
  const Json& accessors = member(primitive, "attributes");
  if (!ids.is_object() || !accessors.is_object()) return bad("lacks its attributes");
  for (const auto& [name, accessor] : accessors.items()) {
    const std::uint64_t id = whole(ids, name, kAbsent);
    if (!is_wanted(name) || id > 0xFFFF'FFFF) continue;
    const auto* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    const auto shape = Accessor::described(document, whole(accessors, name, kAbsent));
    if (!shape) return tl::unexpected(shape.error());
    if (attribute == nullptr ||
        !is_width_clear(name, static_cast<std::uint32_t>(attribute->num_components()),
                        shape->width()) ||
        !copy_values(*attribute, mesh.num_points(), *shape, out.values[name])) {
      return bad("does not match the accessor of " + in_quotes(name));
    }
  }
  return {};
}

}  // namespace

std::uint64_t DracoPrimitive::bytes() const {
  std::uint64_t sum = faces.size() * sizeof(Triangle);
  for (const auto& [name, bytes] : values)
    sum += bytes.size();
  return sum;
}

Expected<DracoPrimitive> decode_draco_primitive(std::span<const std::uint8_t> compressed,
                                                const Json& document, const Json& primitive,
                                                const Limits& limits) {
  const auto decoded = decode_draco_data(compressed, limits);
  if (!decoded)
    return tl::unexpected(Error{decoded.error().code, "glTF: " + decoded.error().message});
  const draco::Mesh& mesh = **decoded;
  DracoPrimitive out;
  out.faces = faces_of(mesh);
  if (auto ok = read_values(mesh, document, primitive, out); !ok) return tl::unexpected(ok.error());
  return out;
}

}  // namespace vitrine::inline codec
