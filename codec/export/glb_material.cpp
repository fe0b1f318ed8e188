// SPDX-License-Identifier: Apache-2.0
#include "codec/export/glb_material.h"

#include <algorithm>
#include <array>
#include <compare>
#include <string_view>
#include <vector>

namespace vitrine::inline codec {
namespace {

struct Sampler {
  bool is_nearest = false;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  auto operator<=>(const Sampler&) const = default;
};

// A glTF texture: a picture with a sampler.
struct PictureUse {
  std::uint32_t picture = 0;
  Sampler sampler;
  auto operator<=>(const PictureUse&) const = default;
};

PictureUse use_of(const TextureMap& map) {
  return {map.picture, {map.is_nearest, map.wrap_u, map.wrap_v}};
}

bool is_png_file(const EncodedPicture& picture) {
  return !picture.bytes.empty() && picture.bytes[0] == 0x89;
}

bool is_webp_file(const EncodedPicture& picture) {
  return !picture.bytes.empty() && picture.bytes[0] == 'R';
}

int wrap_number(Wrap wrap) {
  constexpr std::array<int, 3> kNumbers = {10497, 33648, 33071};
  return kNumbers[static_cast<std::size_t>(wrap)];
}

void put_numbers(FileWriter& json, std::initializer_list<double> numbers) {
  std::string_view separator = "[";
  for (const double number : numbers)
    json.text(separator), json.number(number), separator = ",";
  json.text("]");
}

void put_transform(FileWriter& json, const TextureTransform& transform) {
  json.text(R"(,"extensions":{"KHR_texture_transform":{"offset":)");
  put_numbers(json, {transform.offset[0], transform.offset[1]});
  json.text(R"(,"rotation":)"), json.number(transform.rotation);
  json.text(R"(,"scale":)"), put_numbers(json, {transform.scale[0], transform.scale[1]});
  json.text("}}");
}

bool is_identity(const TextureTransform& t) {
  return t.offset == std::array{0.0, 0.0} && t.scale == std::array{1.0, 1.0} && t.rotation == 0;
}

bool emits_more_than_white(const Material& material) {
  return std::max({material.emission.x, material.emission.y, material.emission.z}) > 1;
}

// Writes the materials of a texturing.
class MaterialWriter {
 public:
  MaterialWriter(FileWriter& json, const Texturing& texturing)
      : json_(json), texturing_(texturing) {
    for (const Material& material : texturing.materials)
      for_each_map(material, [&](const TextureMap& map) { uses_.push_back(use_of(map)); });
    sort_out(uses_);
    for (const PictureUse& use : uses_)
      samplers_.push_back(use.sampler);
    sort_out(samplers_);
  }

  void put(std::size_t first_view) {
    json_.text(R"("materials":[)");
    for (std::size_t i = 0; i < texturing_.materials.size(); ++i)
      json_.text(i == 0 ? "" : ","), put_material(texturing_.materials[i]);
    json_.text("],");
    if (!uses_.empty()) put_textures();
    if (!texturing_.pictures.empty()) put_images(first_view);
  }

  void find_extensions(GlbExtensions& extensions) const {
    const auto& materials = texturing_.materials;
    const bool has_webp = std::ranges::any_of(texturing_.pictures, is_webp_file);
    bool has_transform = false;
    for (const Material& material : materials)
      for_each_map(material, [&](const TextureMap& map) {
        has_transform = has_transform || !is_identity(map.transform);
      });
    const auto add = [&](bool is_used, std::string_view name) {
      if (is_used) extensions.used.push_back(name);
    };
    add(std::ranges::any_of(materials, &Material::is_unlit), "KHR_materials_unlit");
    add(std::ranges::any_of(materials, emits_more_than_white), "KHR_materials_emissive_strength");
    add(has_transform, "KHR_texture_transform");
    add(has_webp, "EXT_texture_webp");
    if (has_webp) extensions.required.emplace_back("EXT_texture_webp");
  }

 private:
  template <class T>
  static void sort_out(std::vector<T>& list) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  template <class T>
  static std::size_t index_in(const std::vector<T>& list, const T& element) {
    return static_cast<std::size_t>(std::ranges::lower_bound(list, element) - list.begin());
  }

  // Writes a member that refers to a texture. `factor` and `value` are the name and the value of a
  // factor, which is left out if its value is 1.
  void put_map(std::string_view name, const std::optional<TextureMap>& map,
               std::string_view factor = {}, double value = 1) {
    if (!map) return;
    json_.text(",\""), json_.text(name), json_.text(R"(":{"index":)");
    json_.number(index_in(uses_, use_of(*map)));
    if (map->coordinates > 0) json_.text(R"(,"texCoord":)"), json_.number(int{map->coordinates});
    if (value != 1) json_.text(","), json_.quoted(factor), json_.text(":"), json_.number(value);
    if (!is_identity(map->transform)) put_transform(json_, map->transform);
    json_.text("}");
  }

  void put_alpha(const Material& material) {
    if (material.alpha_mode == AlphaMode::kBlend) json_.text(R"(,"alphaMode":"BLEND")");
    if (material.alpha_mode != AlphaMode::kMask) return;
    json_.text(R"(,"alphaMode":"MASK","alphaCutoff":)"), json_.number(material.alpha_cutoff);
  }

  // Writes the emission. glTF limits the emissive factor to 1, so larger values need the extension
  // KHR_materials_emissive_strength.
  void put_emission(const Material& material) {
    const Vec3& emission = material.emission;
    const double most = std::max({emission.x, emission.y, emission.z});
    const double strength = std::max(most, 1.0);
    json_.text(R"(,"emissiveFactor":[)"), json_.numbers<double>(emission * (1 / strength), ",");
    json_.text("]");
    if (!material.is_unlit && strength == 1) return;
    std::string_view separator = R"(,"extensions":{)";
    if (material.is_unlit)
      json_.text(separator), json_.text(R"("KHR_materials_unlit":{})"), separator = ",";
    if (strength > 1) {
      json_.text(separator),
          json_.text(R"("KHR_materials_emissive_strength":{"emissiveStrength":)");
      json_.number(strength), json_.text("}");
    }
    json_.text("}");
  }

  void put_material(const Material& material) {
    json_.text(material.is_double_sided ? R"({"doubleSided":true)" : R"({"doubleSided":false)");
    if (!material.name.empty()) json_.text(R"(,"name":)"), json_.quoted(material.name);
    put_alpha(material);
    json_.text(R"(,"pbrMetallicRoughness":{"metallicFactor":)"), json_.number(material.metallic);
    json_.text(R"(,"roughnessFactor":)"), json_.number(material.roughness);
    if (material.base_colour != std::array{1.0, 1.0, 1.0, 1.0}) {
      const auto& [r, g, b, a] = material.base_colour;
      json_.text(R"(,"baseColorFactor":)"), put_numbers(json_, {r, g, b, a});
    }
    put_map("baseColorTexture", material.base_colour_map);
    put_map("metallicRoughnessTexture", material.metallic_roughness_map);
    json_.text("}");
    put_map("normalTexture", material.normal_map, "scale", material.normal_scale);
    put_map("occlusionTexture", material.occlusion_map, "strength", material.occlusion_strength);
    put_map("emissiveTexture", material.emission_map);
    put_emission(material);
    json_.text("}");
  }

  void put_textures() {
    json_.text(R"("samplers":[)");
    for (std::size_t i = 0; i < samplers_.size(); ++i) {
      const Sampler& sampler = samplers_[i];
      json_.text(i == 0 ? "" : ",");
      json_.text(sampler.is_nearest ? R"({"magFilter":9728,"minFilter":9984,"wrapS":)"
                                    : R"({"magFilter":9729,"minFilter":9987,"wrapS":)");
      json_.number(wrap_number(sampler.wrap_u)), json_.text(R"(,"wrapT":)");
      json_.number(wrap_number(sampler.wrap_v)), json_.text("}");
    }
    json_.text(R"(],"textures":[)");
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      const auto& [picture, sampler] = uses_[i];
      const bool is_webp = is_webp_file(texturing_.pictures[picture]);
      json_.text(i == 0 ? "" : ",");
      json_.text(R"({"sampler":)"), json_.number(index_in(samplers_, sampler));
      json_.text(is_webp ? R"(,"extensions":{"EXT_texture_webp":{"source":)" : R"(,"source":)");
      json_.number(picture), json_.text(is_webp ? "}}}" : "}");
    }
    json_.text("],");
  }

  void put_images(std::size_t first_view) {
    json_.text(R"("images":[)");
    for (std::size_t i = 0; i < texturing_.pictures.size(); ++i) {
      const EncodedPicture& picture = texturing_.pictures[i];
      json_.text(i == 0 ? "" : ",");
      json_.text(R"({"mimeType":)");
      json_.text(is_png_file(picture)    ? R"("image/png")"
                 : is_webp_file(picture) ? R"("image/webp")"
                                         : R"("image/jpeg")");
      json_.text(R"(,"bufferView":)"), json_.number(first_view + i), json_.text("}");
    }
    json_.text("],");
  }

  FileWriter& json_;
  const Texturing& texturing_;
  std::vector<PictureUse> uses_;   // the glTF textures, sorted
  std::vector<Sampler> samplers_;  // the glTF samplers, sorted
};

}  // namespace

void put_materials(FileWriter& json, const Texturing& texturing, std::size_t first_view,
                   GlbExtensions& extensions) {
  MaterialWriter writer(json, texturing);
  writer.find_extensions(extensions);
  writer.put(first_view);
}

}  // namespace vitrine::inline codec
