// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/draco_data.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <string>

#include "codec/core/byte_cursor.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint64_t kMostFacesPerByte = 1024;

Unexpected bad(const std::string& what) {
  return bad_input("the Draco data " + what + "; the file is damaged, export it again");
}

// Reads an integer of seven bits per byte, lowest bits first. The highest bit of a byte says
// whether more bytes follow.
std::uint32_t varint(ByteReader& in) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 35; shift += 7) {
    const auto byte = in.read<std::uint8_t>();
    value |= std::uint64_t{byte & 0x7Fu} << shift;
    if (byte < 0x80) break;
  }
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, 0xFFFF'FFFF));
}

// Checks the start of a Draco buffer. Bytes 0-4 are "DRACO", 5-6 the version, 7 the geometry type
// (1: mesh), 8 the method (1: edgebreaker) and 9-10 flags. The counts of vertices and faces follow,
// in an order that depends on the method.
Expected<void> check_header(std::span<const std::uint8_t> bytes, const Limits& limits) {
  constexpr std::uint8_t kName[] = {'D', 'R', 'A', 'C', 'O'};
  if (bytes.size() < 16 || !std::equal(std::begin(kName), std::end(kName), bytes.begin()) ||
      bytes[7] != 1 || bytes[8] > 1) {
    return bad("is not a mesh");
  }
  if (bytes[5] != 2 || bytes[6] != 2) {
    return fail(ErrorCode::kUnsupported,
                "the Draco data is of version " + std::to_string(bytes[5]) + '.' +
                    std::to_string(bytes[6]) + ", only 2.2 is read; export it again");
  }
  if ((bytes[10] & 0x80) != 0) {
    return fail(ErrorCode::kUnsupported,
                "the Draco data carries metadata, which is not read; export without it");
  }
  const bool is_edgebreaker = bytes[8] == 1;
  ByteReader in(bytes.subspan(is_edgebreaker ? 12 : 11));
  const std::uint32_t first = varint(in), second = varint(in);
  const std::uint64_t faces = is_edgebreaker ? second : first;
  const std::uint64_t vertices = is_edgebreaker ? first : second;
  if (!in.is_ok() || faces > kMostFacesPerByte * bytes.size() || vertices > 3 * faces) {
    return bad("claims " + counted(faces, "face") + " in " + counted(bytes.size(), "byte"));
  }
  if (faces > limits.faces || vertices > limits.vertices) {
    return fail(ErrorCode::kLimit, "the Draco data has " + counted(faces, "face") +
                                       ", more than this installation accepts; simplify it first");
  }
  return {};
}

}  // namespace

Expected<std::unique_ptr<draco::Mesh>> decode_draco_data(std::span<const std::uint8_t> bytes,
                                                         const Limits& limits) {
  if (auto ok = check_header(bytes, limits); !ok) return tl::unexpected(ok.error());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return bad(std::string("cannot be decoded: ") + in_quotes(decoded.status().error_msg()));
  return std::move(decoded).value();
}

std::vector<Triangle> faces_of(const draco::Mesh& mesh) {
  std::vector<Triangle> faces;
  faces.reserve(mesh.num_faces());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const auto& face = mesh.face(draco::FaceIndex(f));
    faces.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return faces;
}

}  // namespace vitrine::inline codec
