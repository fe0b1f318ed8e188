// SPDX-License-Identifier: Apache-2.0
#include "codec/build/source_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kMostNameBytes = 1'000;
constexpr std::size_t kMostMaterials = 65'536;
constexpr std::size_t kMaterialBytes = 1 + 12 * 8 + 3;  // minimum size of a material
constexpr std::uint8_t kDoubleSidedBit = 1u << 0, kUnlitBit = 1u << 1;
constexpr std::uint8_t kNearestBit = 1u << 0;
constexpr int kWrapU = 1, kWrapV = 3;  // lowest bit of each two-bit wrap mode

Unexpected bad() {
  return fail(ErrorCode::kBadInput,
              "the materials of the originals are damaged; fetch the file again");
}

// Calls visit(number) for each number of a material, in the order of the file format. `Any` is
// Material or const Material.
template <class Any, class Visit>
void for_each_number(Any& m, Visit visit) {
  for (auto& part : m.base_colour)
    visit(part);
  for (auto* number : {&m.metallic, &m.roughness, &m.normal_scale, &m.occlusion_strength,
                       &m.emission.x, &m.emission.y, &m.emission.z, &m.alpha_cutoff})
    visit(*number);
}

template <class Any, class Visit>
void for_each_number_of_transform(Any& t, Visit visit) {
  for (auto* number : {&t.offset[0], &t.offset[1], &t.scale[0], &t.scale[1], &t.rotation})
    visit(*number);
}

void write_name(ByteWriter& out, const std::string& name) {
  const std::size_t length = std::min(name.size(), kMostNameBytes);
  out.varint(length);
  out.bytes({reinterpret_cast<const std::uint8_t*>(name.data()), length});
}

void write_map(ByteWriter& out, const TextureMap& map) {
  out.varint(map.picture);
  out.u8(map.coordinates);
  out.u8(static_cast<std::uint8_t>((map.is_nearest ? kNearestBit : 0) |
                                   static_cast<int>(map.wrap_u) << kWrapU |
                                   static_cast<int>(map.wrap_v) << kWrapV));
  for_each_number_of_transform(map.transform, [&](double number) { out.f64(number); });
}

void write_material(ByteWriter& out, const Material& material) {
  write_name(out, material.name);
  for_each_number(material, [&](double number) { out.f64(number); });
  out.u8(static_cast<std::uint8_t>(material.alpha_mode));
  out.u8((material.is_double_sided ? kDoubleSidedBit : 0) | (material.is_unlit ? kUnlitBit : 0));
  std::uint8_t maps = 0;
  for (std::size_t i = 0; i < kMapsOfMaterial.size(); ++i)
    maps |= static_cast<std::uint8_t>((material.*kMapsOfMaterial[i] ? 1u : 0u) << i);
  out.u8(maps);
  for_each_map(material, [&](const TextureMap& map) { write_map(out, map); });
}

bool read_name(ByteReader& in, std::string& name) {
  const std::uint64_t length = in.varint();
  if (length > kMostNameBytes) return false;
  for (const std::uint8_t c : in.bytes(length))
    name += static_cast<char>(c);
  return in.is_ok();
}

// Returns false if the number is not finite.
bool read_number(ByteReader& in, double& number) {
  number = in.f64();
  return std::isfinite(number);
}

bool read_map(ByteReader& in, TextureMap& map) {
  const std::uint64_t picture = in.varint();
  map.coordinates = in.u8();
  const std::uint8_t sampler = in.u8();
  const std::uint8_t u = sampler >> kWrapU & 3u, v = sampler >> kWrapV & 3u;
  bool is_good = picture < 0xFFFF'FFFFu && map.coordinates < kCoordinateSets && u < 3 && v < 3 &&
                 (sampler >> 5) == 0;
  map.picture = static_cast<std::uint32_t>(picture);
  map.is_nearest = (sampler & kNearestBit) != 0;
  map.wrap_u = static_cast<Wrap>(u % 3), map.wrap_v = static_cast<Wrap>(v % 3);
  for_each_number_of_transform(
      map.transform, [&](double& number) { is_good = read_number(in, number) && is_good; });
  return is_good && in.is_ok();
}

bool read_material(ByteReader& in, Material& material) {
  if (!read_name(in, material.name)) return false;
  bool is_good = true;
  for_each_number(material, [&](double& number) { is_good = read_number(in, number) && is_good; });
  const std::uint8_t alpha_mode = in.u8(), properties = in.u8(), maps = in.u8();
  if (alpha_mode > static_cast<std::uint8_t>(AlphaMode::kBlend) ||
      properties > (kDoubleSidedBit | kUnlitBit) || (maps >> kMapsOfMaterial.size()) != 0)
    return false;
  material.alpha_mode = static_cast<AlphaMode>(alpha_mode);
  material.is_double_sided = (properties & kDoubleSidedBit) != 0;
  material.is_unlit = (properties & kUnlitBit) != 0;
  for (std::size_t i = 0; i < kMapsOfMaterial.size() && is_good; ++i) {
    if ((maps >> i & 1u) != 0) is_good = read_map(in, (material.*kMapsOfMaterial[i]).emplace());
  }
  return is_good && in.is_ok();
}

bool have_their_pictures(const Texturing& texturing) {
  bool is_good = true;
  for (const Material& material : texturing.materials) {
    for_each_map(material, [&](const TextureMap& map) {
      is_good = is_good && map.picture < texturing.pictures.size();
    });
  }
  return is_good;
}

}  // namespace

void write_source_materials(ByteWriter& out, const Texturing& texturing) {
  out.varint(texturing.materials.size());
  for (const Material& material : texturing.materials)
    write_material(out, material);
  out.varint(texturing.pictures.size());
  for (const EncodedPicture& picture : texturing.pictures)
    write_name(out, picture.name);
}

Expected<Texturing> read_source_materials(ByteReader& in) {
  Texturing out;
  const std::uint64_t materials = in.varint();
  if (materials == 0 || materials > kMostMaterials || materials > in.left() / kMaterialBytes)
    return bad();
  out.materials.resize(materials);
  for (Material& material : out.materials) {
    if (!read_material(in, material)) return bad();
  }
  const std::uint64_t pictures = in.varint();
  if (pictures > in.left()) return bad();
  out.pictures.resize(pictures);
  for (EncodedPicture& picture : out.pictures) {
    if (!read_name(in, picture.name)) return bad();
  }
  if (!in.is_ok() || !have_their_pictures(out)) return bad();
  return out;
}

}  // namespace vitrine::inline codec
