// SPDX-License-Identifier: Apache-2.0
// Writes small COLLADA files for tests.
#pragma once

#include <string>

namespace vitrine::testing {

// A tetrahedron as COLLADA. Tests change the members, which are inserted into the XML at the places
// after which they are named.
struct DaeFile {
  std::string asset = {};
  std::string libraries = {};
  std::string sources = {};  // more elements <source> of the mesh
  std::string inputs = R"(<input semantic="VERTEX" source="#v" offset="0"/>)";
  std::string primitive = "triangles";
  std::string attributes = {};  // more attributes of the primitive
  std::string lists = "<p>0 2 1 0 1 3 1 2 3 2 0 3</p>";
  std::string nodes = R"(<node><instance_geometry url="#g"/></node>)";

  std::string text() const {
    return R"(<?xml version="1.0"?><COLLADA version="1.4.1"><asset>)" + asset + "</asset>" +
           libraries + R"(<library_geometries><geometry id="g"><mesh><source id="p">)" +
           R"(<float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>)" +
           R"(<technique_common><accessor source="#pa" count="4" stride="3"/></technique_common>)" +
           R"(</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)" +
           sources + "<" + primitive + " " + attributes + ">" + inputs + lists + "</" + primitive +
           R"(></mesh></geometry></library_geometries><library_visual_scenes>)" +
           R"(<visual_scene id="s">)" + nodes + "</visual_scene></library_visual_scenes><scene>" +
           R"(<instance_visual_scene url="#s"/></scene></COLLADA>)";
  }
};

// Returns an element <source>. Each of its rows has `width` numbers.
inline std::string dae_source(const std::string& id, const std::string& numbers, int width) {
  return "<source id=\"" + id + "\"><float_array id=\"" + id + "a\">" + numbers +
         "</float_array><technique_common><accessor source=\"#" + id + "a\" stride=\"" +
         std::to_string(width) + "\"/></technique_common></source>";
}

// Returns the XML of a material "m". Its effect has the given parameters and the given shader.
inline std::string dae_material(const std::string& parameters, const std::string& shader) {
  return R"(<library_effects><effect id="e"><profile_COMMON>)" + parameters +
         R"(<technique sid="t">)" + shader +
         R"(</technique></profile_COMMON></effect></library_effects>)" +
         R"(<library_materials><material id="m"><instance_effect url="#e"/></material>)" +
         "</library_materials>";
}

// A node that shows the geometry "g" and binds its material symbol "x" to the material "m".
inline constexpr const char* kDaeDressed =
    R"(<node><instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="x" target="#m"/></technique_common></bind_material></instance_geometry></node>)";

// Returns a DAE whose material shows the picture `file`.
inline DaeFile textured_dae(const std::string& file) {
  return {
      .libraries =
          "<library_images><image id=\"i\"><init_from>" + file +
          "</init_from></image></library_images>" +
          dae_material(
              R"(<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam><newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>)",
              R"(<lambert><diffuse><texture texture="t" texcoord="U"/></diffuse></lambert>)"),
      .sources = dae_source("u", "0.25 0.5 0.75 0.5", 2),
      .inputs =
          R"(<input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#u" offset="1" set="0"/>)",
      .attributes = R"(material="x")",
      .lists = "<p>0 0 2 0 1 0 0 0 1 0 3 1 1 0 2 0 3 1 2 0 0 0 3 1</p>",
      .nodes = kDaeDressed};
}

}  // namespace vitrine::testing
