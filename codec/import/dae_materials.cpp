// SPDX-License-Identifier: Apache-2.0
#include "codec/import/dae_materials.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

using Text = std::string_view;

// Returns the effect's parameter whose sid is `sid`, or an empty node if there is none.
DaeNode parameter(const DaeNode& effect, Text sid) {
  for (const DaeNode& place : {effect, effect.child("profile_COMMON"),
                               effect.child("profile_COMMON").child("technique")}) {
    for (const DaeNode& candidate : place.children("newparam")) {
      if (candidate.attribute("sid").value() == sid) return candidate;
    }
  }
  return {};
}

// Returns the colour of a channel such as "diffuse", or nullopt if the channel has no colour.
std::optional<std::array<double, 4>> colour_of(const DaeNode& channel) {
  const auto numbers = numbers_in(channel.child("color"), 4);
  if (numbers.size() < 3) return std::nullopt;
  return std::array{numbers[0], numbers[1], numbers[2], numbers.size() < 4 ? 1.0 : numbers[3]};
}

// Returns the opacity of a material, computed from its channel "transparent" (its colour and its
// mode) and from the factor `transparency`.
double opacity_of(const std::array<double, 4>& colour, Text mode, double transparency) {
  const double mean = (colour[0] + colour[1] + colour[2]) / 3;
  double opacity = colour[3] * transparency;
  if (mode == "RGB_ZERO") opacity = 1 - mean * transparency;
  if (mode == "RGB_ONE") opacity = mean * transparency;
  if (mode == "A_ZERO") opacity = 1 - colour[3] * transparency;
  // Some programs invert the factor, which makes opaque materials invisible. An opacity of 0 is
  // therefore read as 1.
  return opacity > 0 ? std::min(opacity, 1.0) : 1;
}

}  // namespace

void DaeMaterials::bind(const DaeNode& instance) {
  bound_.clear();
  const DaeNode bindings = instance.child("bind_material").child("technique_common");
  for (const DaeNode& binding : bindings.children("instance_material"))
    bound_[binding.attribute("symbol").value()] =
        document_.find(binding.attribute("target").value());
}

std::string DaeMaterials::define(std::string_view symbol) {
  if (symbol.empty()) return {};
  const auto bound = bound_.find(symbol);
  const DaeNode material = bound == bound_.end() ? document_.find(symbol) : bound->second;
  const auto [known, is_new] = defined_.try_emplace(material.hash_value());
  auto& [key, name] = *known;
  if (is_new && material.name() == Text("material")) {
    name = material.attribute("id").value();
    materials_.define(name, read(material));
  }
  work_.add(name.size());
  return name.empty() ? std::string(symbol) : name;
}

ObjMaterial DaeMaterials::read(const DaeNode& material) const {
  ObjMaterial out{.opacity_map_name = "transparent", .bump_map_name = "bump"};
  const DaeNode effect = document_.find(material.child("instance_effect").attribute("url").value());
  const DaeNode technique = effect.child("profile_COMMON").child("technique");
  work_.add(DaeDocument::size_of(material) + DaeDocument::size_of(effect));
  read_technique(effect, technique, out);
  return out;
}

void DaeMaterials::read_technique(const DaeNode& effect, const DaeNode& technique,
                                  ObjMaterial& out) const {
  constexpr std::array kShaders{"phong", "lambert", "blinn", "constant"};
  DaeNode shader;
  for (const char* name : kShaders) {
    if (technique.child(name)) shader = technique.child(name);
  }
  out.diffuse_map = map(effect, shader.child("diffuse"));
  out.emission_map = map(effect, shader.child("emission"));
  if (const auto colour = colour_of(shader.child("diffuse")))
    out.diffuse = {(*colour)[0], (*colour)[1], (*colour)[2]};
  if (const auto colour = colour_of(shader.child("emission")))
    out.emission = {(*colour)[0], (*colour)[1], (*colour)[2]};
  // Without a diffuse colour, the shader "constant" shows its emission alone.
  if (shader.name() == Text("constant") && !shader.child("diffuse"))
    out.diffuse = std::array<double, 3>{0, 0, 0};
  read_opacity(effect, shader, out);
  DaeNode bump;
  for (const DaeNode& extra : technique.children("extra")) {
    for (const DaeNode& inner : extra.children("technique")) {
      if (!bump) bump = inner.child("bump");
    }
  }
  out.bump_map = map(effect, bump);
}

void DaeMaterials::read_opacity(const DaeNode& effect, const DaeNode& shader,
                                ObjMaterial& out) const {
  const DaeNode channel = shader.child("transparent");
  const auto factor = numbers_in(shader.child("transparency").child("float"), 1);
  out.opacity_map = map(effect, channel);
  if (const auto colour = colour_of(channel))
    out.opacity =
        opacity_of(*colour, channel.attribute("opaque").value(), factor.empty() ? 1.0 : factor[0]);
}

ObjMap DaeMaterials::map(const DaeNode& effect, const DaeNode& channel) const {
  const char* sid = channel.child("texture").attribute("texture").value();
  const DaeNode sampler = parameter(effect, sid).child("sampler2D");
  const DaeNode surface = parameter(effect, sampler.child("source").child_value()).child("surface");
  // The texture names a sampler, which names a surface or an image. Some programs name the image
  // directly.
  DaeNode image = document_.find(sid);
  if (surface) image = document_.find(surface.child("init_from").child_value());
  if (const DaeNode instance = sampler.child("instance_image"))
    image = document_.find(instance.attribute("url").value());
  work_.add(DaeDocument::size_of(image));
  if (image.name() != Text("image")) return {};
  const DaeNode from = image.child("init_from");
  const char* uri = from.child("ref") ? from.child("ref").child_value() : from.child_value();
  const auto clamps = [&](const char* axis) {
    const Text mode = sampler.child(axis).child_value();
    return mode == "CLAMP" || mode == "BORDER";
  };
  return {.name = percent_decoded(uri), .is_clamped = clamps("wrap_s") && clamps("wrap_t")};
}

}  // namespace vitrine::inline codec
