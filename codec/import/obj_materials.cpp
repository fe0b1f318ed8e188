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

// Whether the text begins with a byte order mark of UTF-16.
bool is_utf16(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 2 &&
         ((bytes[0] == 0xFF && bytes[1] == 0xFE) || (bytes[0] == 0xFE && bytes[1] == 0xFF));
}

}  // namespace

Expected<void> ObjMaterials::open_library(std::string_view name) {
  const auto found = find_companion(companions_, {without_quotes(without_end_blanks(name))});
  if (!found) return tl::unexpected(found.error());
  const auto& [key, bytes] = **found;
  if (is_utf16(bytes)) return bad_input("is text in UTF-16; save it as UTF-8");
  has_library_ = true;
  const auto [library, is_new] = opened_.try_emplace(key, companion_path(key));
  if (!is_new) return {};
  std::string& folder = library->second;
  folder.resize(folder.rfind('/') + 1);
  read_obj_library(bytes, folder, library_);
  return {};
}

void ObjMaterials::define(std::string name, ObjMaterial material) {
  has_library_ = true;
  name.resize(without_end_blanks(name).size());  // use() also removes blanks at the end
  library_.insert_or_assign(std::move(name), std::move(material));
}

std::uint16_t ObjMaterials::use(std::string_view name) {
  name = without_end_blanks(name);
  current_ = find(name);
  // Some programs write a comment after the name. A name itself may contain " #".
  if (const std::size_t comment = name.find(" #"); current_ == nullptr && comment != name.npos)
    current_ = find(without_end_blanks(name.substr(0, comment)));
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
  if (material.picture == nullptr && !source.diffuse_fault.empty())
    ++diffuse_faults_[source.diffuse_fault];
  material.index = carry(it->first, source, material);
  return &used_.emplace(it->first, material).first->second;
}

// Chooses the source of the vertex colours: the diffuse map or colour. Uses the emission instead if
// the diffuse colour is black and has no map.
void ObjMaterials::bake(const ObjMaterial& source, UsedMaterial& out) {
  const bool is_black = source.diffuse == std::array<double, 3>{0, 0, 0};
  out.map = source.diffuse_map.empty() && is_black ? source.emission_map : source.diffuse_map;
  if (!out.map.empty()) {
    out.picture = pictures_.find(out.map.path());
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
  for (const std::string_view name : source.unread) {
    // Programs often repeat map_Kd as map_Ka, which adds nothing.
    if (name != "map_Ka" || source.diffuse_map.empty()) unread_.insert(name);
  }
  if (!source.opacity_map.empty()) {
    if (source.opacity_map.name == source.diffuse_map.name)
      out.alpha_mode = AlphaMode::kBlend;
    else
      unread_.insert(source.opacity_map_name);
  }
  out.normal_map = map(source.normal_map);
  if (source.normal_map.empty() && !source.bump_map.empty()) {
    if (pictures_.shows_normals(source.bump_map.path()))
      out.normal_map = map(source.bump_map);
    else
      unread_.insert(source.bump_map_name);
  }
  out.emission_map = map(source.emission_map);
  if (out.emission_map && out.emission == Vec3{}) out.emission = {1, 1, 1};
}

std::optional<TextureMap> ObjMaterials::map(const ObjMap& source) {
  if (source.empty()) return std::nullopt;
  const auto picture = pictures_.carry(source.path());
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
  const auto plain = std::count_if(used_.begin(), used_.end(), [](const auto& entry) {
    return entry.second.picture == nullptr;
  });
  if (plain > 0)
    lines.push_back("colours of " + counted(static_cast<std::uint64_t>(plain), "material") +
                    " baked into vertex colours; use texture maps to keep their borders sharp");
  return lines;
}

std::vector<std::string> ObjMaterials::report_unread() const {
  std::vector<std::string> lines;
  std::string names;
  const bool is_mtl = !opened_.empty();  // otherwise the mesh file defines the materials
  for (const std::string_view name : unread_)
    names += (names.empty() ? "" : ", ") + std::string(name);
  if (!names.empty()) {
    lines.push_back(counted(unread_.size(), "kind") + " of material maps not carried: " + names +
                    (is_mtl
                         ? "; bake them into the diffuse map (map_Kd), or into a normal map (norm)"
                         : "; bake them into the diffuse map, or into a normal map"));
  }
  for (const auto& [fault, materials] : diffuse_faults_)
    lines.push_back("colours of " + counted(materials, "material") + std::string(fault));
  if (!unknown_.empty()) {
    lines.push_back(counted(unknown_.size(), "material") +
                    (is_mtl ? " not in the material library" : " not in the file") + ", such as " +
                    in_quotes(*unknown_.begin()) + "; faces that use it are uncoloured, so " +
                    (is_mtl ? "add it to the library" : "export the model with its materials"));
  }
  if (beyond_limit_ > 0) {
    lines.push_back(counted(beyond_limit_, "material") + " not carried: at most " +
                    std::to_string(kMostUsedMaterials) + " are; merge them");
  }
  return lines;
}

}  // namespace vitrine::inline codec
