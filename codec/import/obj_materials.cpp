// SPDX-License-Identifier: Apache-2.0
#include "codec/import/obj_materials.h"

#include <algorithm>

#include "codec/mesh/plain_material.h"
#include "codec/picture/sample.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kMostUsedMaterials = 0xFFFF;  // one more is kept for faces without a material

LinearColour linear_diffuse(const ObjMaterial& material) {
  const auto [r, g, b] = material.diffuse.value_or(std::array<double, 3>{1, 1, 1});
  return to_linear({to_byte(r), to_byte(g), to_byte(b)});
}

}  // namespace

bool ObjMaterials::open_library(std::string_view name) {
  name = without_end_blanks(name);
  const auto bytes = find_companion(companions_, name);
  if (!bytes) return false;
  has_library_ = true;
  if (opened_.insert(companion_key(name)).second) read_obj_library(*bytes, library_);
  return true;
}

std::uint16_t ObjMaterials::use(std::string_view name) {
  name = without_end_blanks(name);
  current_ = find(name);
  if (current_ != nullptr) return current_->index;
  if (has_library_ && !name.empty() && !unknown_.contains(name)) unknown_.emplace(name);
  return plain();
}

const ObjMaterials::UsedMaterial* ObjMaterials::find(std::string_view name) {
  if (const auto known = used_.find(name); known != used_.end()) return &known->second;
  const auto it = library_.find(name);
  if (it == library_.end()) return nullptr;
  const ObjMaterial& source = it->second;
  UsedMaterial material{.diffuse = linear_diffuse(source)};
  bake(source, material);
  material.index = carry(it->first, source, material);
  return &used_.emplace(it->first, material).first->second;
}

// Chooses the source of the vertex colours: the diffuse map or colour. Uses the emission instead if
// the diffuse colour is black and has no map.
void ObjMaterials::bake(const ObjMaterial& source, UsedMaterial& out) {
  const bool is_black = source.diffuse == std::array<double, 3>{0, 0, 0};
  out.map = source.diffuse_map.empty() && is_black ? source.emission_map : source.diffuse_map;
  if (!out.map.empty()) {
    out.picture = pictures_.find(out.map.name);
  } else if (is_black) {
    const auto [r, g, b] = source.emission;
    out.diffuse = to_linear({to_byte(r), to_byte(g), to_byte(b)});
  }
}

std::uint16_t ObjMaterials::carry(std::string name, const ObjMaterial& source,
                                  const UsedMaterial& used) {
  if (carried_.size() >= kMostUsedMaterials) return ++beyond_limit_, plain();
  Material out{.name = std::move(name)};
  const bool has_picture = used.picture != nullptr && !source.diffuse_map.empty();
  const LinearColour colour = has_picture ? LinearColour{1, 1, 1} : linear_diffuse(source);
  out.base_colour = {colour[0], colour[1], colour[2], source.opacity};
  out.metallic = source.metallic;
  out.roughness = source.roughness;
  out.emission = source.emission;
  if (has_picture) out.base_colour_map = map(source.diffuse_map);
  carry_other_maps(source, out);
  if (source.opacity < 1) out.alpha_mode = AlphaMode::kBlend;
  for_each_map(out, [&](const TextureMap&) { has_maps_ = true; });
  carried_.push_back(std::move(out));
  return static_cast<std::uint16_t>(carried_.size() - 1);
}

void ObjMaterials::carry_other_maps(const ObjMaterial& source, Material& out) {
  unread_.insert(source.unread.begin(), source.unread.end());
  if (!source.opacity_map.empty()) {
    if (source.opacity_map.name == source.diffuse_map.name)
      out.alpha_mode = AlphaMode::kBlend;
    else
      unread_.insert("map_d");
  }
  out.normal_map = map(source.normal_map);
  if (source.normal_map.empty() && !source.bump_map.empty()) {
    if (pictures_.shows_normals(source.bump_map.name))
      out.normal_map = map(source.bump_map);
    else
      unread_.insert("map_Bump");
  }
  out.emission_map = map(source.emission_map);
  if (out.emission_map && out.emission == Vec3{}) out.emission = {1, 1, 1};
}

std::optional<TextureMap> ObjMaterials::map(const ObjMap& source) {
  if (source.empty()) return std::nullopt;
  const auto picture = pictures_.carry(source.name);
  if (!picture) return std::nullopt;
  return TextureMap{.picture = *picture,
                    .wrap_u = source.wrap(),
                    .wrap_v = source.wrap(),
                    .transform = source.transform()};
}

std::uint16_t ObjMaterials::plain() {
  if (!plain_) {
    plain_ = static_cast<std::uint16_t>(carried_.size());
    carried_.emplace_back();
  }
  return *plain_;
}

LinearColour ObjMaterials::colour_at(double u, double v) const {
  if (current_ == nullptr) return {1, 1, 1};
  if (current_->picture == nullptr) return current_->diffuse;
  const auto& [offset, scale, rotation] = current_->map.transform();
  const Wrap wrap = current_->map.wrap();
  return sample(*current_->picture, offset[0] + scale[0] * u, offset[1] + scale[1] * (1 - v), wrap,
                wrap);
}

bool ObjMaterials::are_plain() const {
  return std::ranges::all_of(carried_, is_plain);
}

void ObjMaterials::give_to(RawMesh& mesh) {
  if (are_plain()) return;
  mesh.materials = std::move(carried_);
  mesh.pictures = pictures_.take();
}

std::vector<std::string> ObjMaterials::report_baked() const {
  std::vector<std::string> lines = pictures_.report_faults();
  const auto decoded = pictures_.report_decoded();
  lines.insert(lines.end(), decoded.begin(), decoded.end());
  const bool has_plain = std::any_of(used_.begin(), used_.end(), [](const auto& entry) {
    return entry.second.picture == nullptr;
  });
  if (has_plain) lines.emplace_back("material colours baked into vertex colours");
  return lines;
}

std::vector<std::string> ObjMaterials::report_unread() const {
  std::vector<std::string> lines;
  std::string names;
  for (const std::string_view name : unread_)
    names += (names.empty() ? "" : ", ") + std::string(name);
  if (!names.empty()) {
    lines.push_back("material maps not carried: " + names +
                    "; bake them into map_Kd, or into a normal map named by norm");
  }
  if (!unknown_.empty()) {
    lines.push_back(counted(unknown_.size(), "material") +
                    " not in the material library, such as " + in_quotes(*unknown_.begin()) +
                    "; faces that use it are uncoloured, so add it to the library");
  }
  if (beyond_limit_ > 0) {
    lines.push_back(counted(beyond_limit_, "material") + " not carried: at most " +
                    std::to_string(kMostUsedMaterials) + " are; merge them");
  }
  return lines;
}

}  // namespace vitrine::inline codec
