// SPDX-License-Identifier: Apache-2.0
#include "codec/import/draco_primitive.h"

#include <draco/compression/decode.h>

#include <cstring>

#include "codec/import/byte_cursor.h"
#include "codec/import/gltf_accessor.h"
#include "codec/import/raw_mesh.h"

namespace vitrine {
namespace {

constexpr std::uint64_t kMostFacesPerByte = 1024;

Unexpected bad(const std::string& what) {
  return bad_input("GLB: the Draco data " + what + "; the file is damaged, export it again");
}

// Seven bits a byte, the lowest first; the highest bit says that more follow.
std::uint32_t varint(ByteCursor& in) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 35; shift += 7) {
    const auto byte = in.read<std::uint8_t>();
    value |= std::uint64_t{byte & 0x7Fu} << shift;
    if (byte < 0x80) break;
  }
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, 0xFFFF'FFFF));
}

// Bytes 0-4 "DRACO", 5-6 version, 7 geometry type (1 mesh), 8 method (1 edgebreaker), 9-10 flags;
// then the counts of the connectivity, of vertices and faces in either order.
Expected<void> check_header(std::span<const std::uint8_t> bytes, const Limits& limits) {
  constexpr std::uint8_t kName[] = {'D', 'R', 'A', 'C', 'O'};
  if (bytes.size() < 16 || !std::equal(std::begin(kName), std::end(kName), bytes.begin()) ||
      bytes[7] != 1 || bytes[8] > 1) {
    return bad("is not a mesh");
  }
  if (bytes[5] != 2 || bytes[6] != 2) {
    return fail(ErrorCode::kUnsupported,
                "GLB: the Draco data is of version " + std::to_string(bytes[5]) + '.' +
                    std::to_string(bytes[6]) + ", only 2.2 is read; export it again");
  }
  if ((bytes[10] & 0x80) != 0) {
    return fail(ErrorCode::kUnsupported,
                "GLB: the Draco data carries metadata, which is not read; export without it");
  }
  const bool is_edgebreaker = bytes[8] == 1;
  ByteCursor in(bytes.subspan(is_edgebreaker ? 12 : 11));
  const std::uint32_t first = varint(in), second = varint(in);
  const std::uint64_t faces = is_edgebreaker ? second : first;
  const std::uint64_t vertices = is_edgebreaker ? first : second;
  if (in.overrun() || faces > kMostFacesPerByte * bytes.size() || vertices > 3 * faces) {
    return bad("claims " + counted(faces, "face") + " in " + counted(bytes.size(), "byte"));
  }
  if (faces > limits.faces || vertices > limits.vertices) {
    return fail(ErrorCode::kLimit, "the GLB's Draco data has " + counted(faces, "face") +
                                       ", more than this installation accepts; simplify it first");
  }
  return {};
}

template <class T>
bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points, std::uint32_t width,
                 std::vector<std::uint8_t>& out) {
  out.resize(std::size_t{points} * width * sizeof(T));
  std::vector<T> value(width);
  for (std::uint32_t p = 0; p < points; ++p) {
    const auto at = attribute.mapped_index(draco::PointIndex(p));
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(at, static_cast<std::int8_t>(width), value.data())) {
      return false;
    }
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
  return name == "POSITION" || name == "COLOR_0" || name.starts_with("TEXCOORD_");
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
    if (!shape) return Unexpected(shape.error());
    if (attribute == nullptr || shape->count() != mesh.num_points() ||
        shape->width() != static_cast<std::uint32_t>(attribute->num_components()) ||
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
  if (auto ok = check_header(compressed, limits); !ok) return Unexpected(ok.error());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(compressed.data()), compressed.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return bad(std::string("cannot be decoded: ") + in_quotes(decoded.status().error_msg()));
  const draco::Mesh& mesh = *decoded.value();
  DracoPrimitive out;
  out.faces.reserve(mesh.num_faces());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const auto& face = mesh.face(draco::FaceIndex(f));
    out.faces.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  if (auto ok = read_values(mesh, document, primitive, out); !ok) return Unexpected(ok.error());
  return out;
}

}  // namespace vitrine
