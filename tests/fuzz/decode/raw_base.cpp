// SPDX-License-Identifier: Apache-2.0
#include "raw_base.h"

#include "codec/core/byte_cursor.h"

namespace vitrine::fuzz {
namespace {

std::vector<Vec3i> read_triples(ByteReader& in, std::uint32_t count) {
  std::vector<Vec3i> out;
  for (std::uint32_t i = 0; i < count && in.left() >= 12; ++i) {
    const auto x = static_cast<std::int32_t>(in.u32());
    const auto y = static_cast<std::int32_t>(in.u32());
    const auto z = static_cast<std::int32_t>(in.u32());
    out.push_back({x, y, z});
  }
  return out;
}

void write_triple(ByteWriter& out, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  out.u32(a);
  out.u32(b);
  out.u32(c);
}

void write_triples(ByteWriter& out, std::span<const Vec3i> triples) {
  for (const Vec3i& t : triples) {
    write_triple(out, static_cast<std::uint32_t>(t.x), static_cast<std::uint32_t>(t.y),
                 static_cast<std::uint32_t>(t.z));
  }
}

}  // namespace

BaseMesh read_raw_base(std::span<const std::uint8_t> bytes, const Manifest& manifest) {
  ByteReader in(bytes);
  BaseMesh base;
  const LevelInfo& level = manifest.levels.front();
  base.positions = read_triples(in, level.vertices);
  for (const Vec3i& f : read_triples(in, level.faces)) {
    base.faces.push_back({static_cast<std::uint32_t>(f.x), static_cast<std::uint32_t>(f.y),
                          static_cast<std::uint32_t>(f.z)});
  }
  for (const Semantic semantic : manifest.attributes)
    base.attributes.push_back({semantic, read_triples(in, level.vertices)});
  return base;
}

std::vector<std::uint8_t> with_raw_base(std::span<const std::uint8_t> pmesh, Manifest manifest,
                                        const BaseMesh& base) {
  const auto behind_base = pmesh.subspan(manifest.base_offset + manifest.base_length);
  ByteWriter raw;
  write_triples(raw, base.positions);
  for (const Triangle& f : base.faces)
    write_triple(raw, f[0], f[1], f[2]);
  for (const auto& column : base.attributes)
    write_triples(raw, column.values);
  manifest.base_length = raw.size();
  ByteWriter out;
  out.bytes(write_header(manifest));
  out.bytes(raw.take());
  out.bytes(behind_base);
  return out.take();
}

}  // namespace vitrine::fuzz
