// SPDX-License-Identifier: Apache-2.0
#include "codec/export/usd_material.h"

#include <array>
#include <string_view>

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kMaterialStart = R"(
    def Material "material"
    {
        token outputs:surface.connect = </model/material/surface.outputs:surface>

        def Shader "surface"
        {
            uniform token info:id = "UsdPreviewSurface"
            token outputs:surface
)";
constexpr std::string_view kShaderEnd = "        }\n";
constexpr std::string_view kMaterialEnd = "    }\n";

// Shader that reads the vertex colours.
constexpr std::string_view kColourReader = R"(
        def Shader "colours"
        {
            uniform token info:id = "UsdPrimvarReader_float3"
            string inputs:varname = "displayColor"
            float3 outputs:result
        }
)";
// Shader that reads the texture coordinates.
constexpr std::string_view kCoordinateReader = R"(
        def Shader "coordinates"
        {
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }
)";

// A map of a material, and the shader that samples its picture.
struct Sampling {
  MapOfMaterial map;
  std::string_view shader, colour_space;
};
constexpr Sampling kSamplings[] = {{&Material::base_colour_map, "base_colour", "sRGB"},
                                   {&Material::normal_map, "normal", "raw"},
                                   {&Material::metallic_roughness_map, "metallic_roughness", "raw"},
                                   {&Material::occlusion_map, "occlusion", "raw"},
                                   {&Material::emission_map, "emission", "sRGB"}};

// An input of the surface shader. If the material has the map, the input gets its values from this
// channel of the map's picture.
struct MappedInput {
  MapOfMaterial map;
  std::string_view input, channel;
};
constexpr MappedInput kMappedInputs[] = {
    {&Material::base_colour_map, "color3f inputs:diffuseColor", "base_colour.outputs:rgb"},
    {&Material::normal_map, "normal3f inputs:normal", "normal.outputs:rgb"},
    {&Material::metallic_roughness_map, "float inputs:metallic", "metallic_roughness.outputs:b"},
    {&Material::metallic_roughness_map, "float inputs:roughness", "metallic_roughness.outputs:g"},
    {&Material::occlusion_map, "float inputs:occlusion", "occlusion.outputs:r"},
    {&Material::emission_map, "color3f inputs:emissiveColor", "emission.outputs:rgb"}};

void put_connection(FileWriter& out, std::string_view input, std::string_view output) {
  out.text("            "), out.text(input);
  out.text(".connect = </model/material/"), out.text(output), out.text(">\n");
}

void put_value(FileWriter& out, std::string_view input, double value) {
  out.text("            "), out.text(input), out.text(" = "), out.number(value), out.text("\n");
}

void put_surface_inputs(FileWriter& out, const Material& material) {
  for (const auto& [map, input, channel] : kMappedInputs) {
    if (material.*map) put_connection(out, input, channel);
  }
  if (!material.base_colour_map) {
    const auto& [red, green, blue, opacity] = material.base_colour;
    out.text("            color3f inputs:diffuseColor = (");
    out.numbers<double>({red, green, blue}, ", "), out.text(")\n");
  }
  if (!material.metallic_roughness_map) {
    put_value(out, "float inputs:metallic", material.metallic);
    put_value(out, "float inputs:roughness", material.roughness);
  }
  if (material.alpha_mode != AlphaMode::kOpaque && material.base_colour_map)
    put_connection(out, "float inputs:opacity", "base_colour.outputs:a");
  if (material.alpha_mode == AlphaMode::kMask)
    put_value(out, "float inputs:opacityThreshold", material.alpha_cutoff);
}

void put_wrap(FileWriter& out, std::string_view input, Wrap wrap) {
  constexpr std::array<std::string_view, 3> kNames = {"repeat", "mirror", "clamp"};
  out.text("            token inputs:"), out.text(input), out.text(" = ");
  out.quoted(kNames[static_cast<std::size_t>(wrap)]), out.text("\n");
}

void put_sampling(FileWriter& out, const Sampling& sampling, const TextureMap& map,
                  std::string_view file) {
  out.text("\n        def Shader "), out.quoted(sampling.shader);
  out.text("\n        {\n            uniform token info:id = \"UsdUVTexture\"\n");
  out.text("            asset inputs:file = @./"), out.text(file), out.text("@\n");
  put_connection(out, "float2 inputs:st", "coordinates.outputs:result");
  out.text("            token inputs:sourceColorSpace = "), out.quoted(sampling.colour_space);
  out.text("\n");
  put_wrap(out, "wrapS", map.wrap_u), put_wrap(out, "wrapT", map.wrap_v);
  if (sampling.map == &Material::normal_map) {  // maps 0 … 1 to -1 … 1
    out.text(
        "            float4 inputs:scale = (2, 2, 2, 1)\n"
        "            float4 inputs:bias = (-1, -1, -1, 0)\n");
  }
  for (const std::string_view channel : {"r", "g", "b", "a"})
    out.text("            float outputs:"), out.text(channel), out.text("\n");
  out.text("            float3 outputs:rgb\n"), out.text(kShaderEnd);
}

}  // namespace

void put_usd_material(FileWriter& out, const Texturing& texturing) {
  const Material& material = texturing.materials.front();
  out.text(kMaterialStart), put_surface_inputs(out, material), out.text(kShaderEnd);
  for (const Sampling& sampling : kSamplings) {
    if (const auto& map = material.*sampling.map)
      put_sampling(out, sampling, *map, texturing.pictures[map->picture].name);
  }
  out.text(kCoordinateReader), out.text(kMaterialEnd);
}

void put_plain_usd_material(FileWriter& out, bool is_coloured) {
  out.text(kMaterialStart);
  if (is_coloured) {
    put_connection(out, "color3f inputs:diffuseColor", "colours.outputs:result");
  } else {
    out.text("            color3f inputs:diffuseColor = (1, 1, 1)\n");
  }
  put_value(out, "float inputs:metallic", 0), put_value(out, "float inputs:roughness", 0.8);
  out.text(kShaderEnd);
  if (is_coloured) out.text(kColourReader);
  out.text(kMaterialEnd);
}

}  // namespace vitrine::inline codec
