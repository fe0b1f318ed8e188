// SPDX-License-Identifier: Apache-2.0
// Reads the model part of a 3MF package [3MF]: the objects that the build items place, with their
// triangles, components and colours. The other parts of the package are its companions.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "codec/core/parse_number.h"
#include "codec/gltf/affine.h"
#include "codec/import/readers.h"
#include "codec/import/stated_colours.h"
#include "codec/import/text_cursor.h"
#include "codec/import/xml_names.h"

namespace vitrine::inline codec {
namespace {

using Node = pugi::xml_node;

// A unit of 3MF, the unit that the mesh gets, and the factor between the two.
struct ThreeMfUnit {
  std::string_view name, given;
  double scale;
};
constexpr ThreeMfUnit kThreeMfUnits[] = {{"millimeter", "mm", 1}, {"centimeter", "cm", 1},
                                         {"meter", "m", 1},       {"inch", "in", 1},
                                         {"foot", "in", 12},      {"micron", "mm", 0.001}};

// the element "model" begins within this number of bytes
constexpr std::size_t kThreeMfStart = 4'096;

std::string_view start_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kThreeMfStart)};
}

// Returns the unit that the element "model" states, or millimetres if it states none, as the 3MF
// standard demands.
const ThreeMfUnit& unit_in(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kUnit = " unit=";
  std::string_view text = start_of(bytes);
  text.remove_prefix(std::min(text.find("<model"), text.size()));
  text = text.substr(0, text.find('>'));
  text.remove_prefix(std::min(text.find(kUnit), text.size()));
  text.remove_prefix(std::min(kUnit.size() + 1, text.size()));
  const std::string_view name = text.substr(0, text.find_first_of("\"'"));
  const auto* found = std::ranges::find(kThreeMfUnits, name, &ThreeMfUnit::name);
  return found == std::end(kThreeMfUnits) ? kThreeMfUnits[0] : *found;
}

// Returns the value of an attribute with any namespace prefix, or an empty text if the attribute is
// missing.
std::string_view value_of(const Node& node, std::string_view name) {
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    if (local_name(attribute.name()) == name) return attribute.value();
  }
  return {};
}

template <class Number>
std::optional<Number> number_in(const Node& node, std::string_view name) {
  return parse_number<Number>(value_of(node, name));
}

// Returns the transform of an element, or nullopt if it is damaged. The file states twelve numbers;
// the first three are the image of the x axis.
std::optional<Affine> affine_of(const Node& node) {
  const std::string_view text = value_of(node, "transform");
  if (text.empty()) return Affine{};
  TextCursor cursor({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::array<double, 12> m{};
  for (double& number : m) {
    if (cursor.read_number(number)) continue;
    const auto with_comma = parse_real(cursor.word());
    if (!with_comma) return std::nullopt;
    number = *with_comma;
  }
  return Affine{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}, {m[9], m[10], m[11]}};
}

// Whether a slicer's user painted the triangle with a filament. Bambu Studio and OrcaSlicer write
// the attribute paint_color, PrusaSlicer writes mmu_segmentation.
bool is_painted(const Node& triangle) {
  return !value_of(triangle, "paint_color").empty() ||
         !value_of(triangle, "mmu_segmentation").empty();
}

// Parses a colour such as "#FF8000" or "#FF8000FF".
StatedColour colour_in(std::string_view text) {
  constexpr std::size_t kDigits = 6;
  StatedColour colour{};
  if (text.size() <= kDigits || text[0] != '#') return kNoColour;
  for (std::size_t k = 0; k < 3; ++k) {
    unsigned value = 0;
    const char* begin = text.data() + 1 + 2 * k;
    if (std::from_chars(begin, begin + 2, value, 16).ptr != begin + 2) return kNoColour;
    colour[k] = static_cast<float>(value) / 255;
  }
  return colour;
}

// Whether a colour such as "#FF800080" states an opacity that is less than full.
bool is_translucent_colour(std::string_view text) {
  constexpr std::size_t kOpacity = 7;
  return text.size() == kOpacity + 2 && lower_case(text.substr(kOpacity)) != "ff";
}

// One model file of the package.
struct ModelPart {
  pugi::xml_document document;
  std::map<std::string_view, Node> objects;                       // key: ID of the object
  std::map<std::string_view, std::vector<StatedColour>> colours;  // key: ID of the colour group
  std::uint64_t translucent_colours = 0;

  bool load(std::span<const std::uint8_t> bytes) {
    if (!document.load_buffer(bytes.data(), bytes.size(), pugi::parse_minimal)) return false;
    for (const Node& resource : document.child("model").child("resources").children())
      add(resource);
    return true;
  }

 private:
  void add(const Node& resource) {
    const std::string_view kind = local_name(resource.name()), id = value_of(resource, "id");
    if (kind == "object") objects.emplace(id, resource);
    if (kind != "basematerials" && kind != "colorgroup") return;
    auto& group = colours[id];
    for (const Node& colour : resource.children()) {
      const auto text = value_of(colour, kind == "colorgroup" ? "color" : "displaycolor");
      group.push_back(colour_in(text));
      translucent_colours += is_translucent_colour(text);
    }
  }
};

class ThreeMfReader {
 public:
  explicit ThreeMfReader(const ReadOptions& options) : options_(options) { mesh_.format = "3MF"; }

  Expected<RawMesh> read(std::span<const std::uint8_t> bytes) {
    const ModelPart* root = part("", bytes);
    if (root == nullptr) return damaged();
    if (auto ok = check_extensions(root->document.child("model")); !ok)
      return tl::unexpected(ok.error());
    const double scale = unit_in(bytes).scale;
    // 3MF files have z up.
    const Affine to_y_up{{scale, 0, 0}, {0, 0, -scale}, {0, scale, 0}, {}};
    for (const Node& item : root->document.child("model").child("build").children("item")) {
      if (auto ok = place(*root, item, to_y_up, 0); !ok) return tl::unexpected(ok.error());
    }
    if (mesh_.face_count() == 0)
      return bad_input("the 3MF places no object with triangles; export the model again");
    if (has_colours_) colours_.give_to(mesh_);
    report();
    return std::move(mesh_);
  }

 private:
  static Unexpected damaged() {
    return bad_input("the 3MF's XML is damaged; export the file again");
  }

  // Reads the list of prefixes in `requiredextensions`. Each prefix stands for the namespace of an
  // extension. Fails if an extension that is not read changes the shape of the meshes [3MF].
  Expected<void> check_extensions(const Node& model) {
    constexpr std::array<std::string_view, 2> kRead{"/material/", "/production/"};
    constexpr std::array<std::string_view, 5> kOfShape{"boolean", "displacement", "volumetric",
                                                       "implicit", "securecontent"};
    const std::string_view text = value_of(model, "requiredextensions");
    TextCursor prefixes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    while (prefixes.seek_word()) {
      const std::string prefix(prefixes.word());
      const std::string_view name = model.attribute(("xmlns:" + prefix).c_str()).value();
      const auto contains = [&](std::string_view part) { return name.find(part) != name.npos; };
      if (std::ranges::any_of(kRead, contains)) continue;
      const std::string shown = in_quotes(name.empty() ? prefix : name);
      if (std::ranges::any_of(kOfShape, contains))
        return fail(ErrorCode::kUnsupported, "the 3MF needs the extension " + shown +
                                                 ", which is not read; export it as a plain mesh");
      unread_extensions_.insert(shown);
    }
    return {};
  }

  void report() {
    if (textured_ > 0)
      mesh_.repairs.push_back("textures or mixed materials of " + counted(textured_, "face") +
                              " not carried: those of 3MF are not read; export GLB");
    if (painted_ > 0)
      mesh_.repairs.push_back("colours painted in the slicer on " + counted(painted_, "face") +
                              " not carried: 3MF does not define them; paint the model in another "
                              "program and export GLB");
    if (beams_ > 0)
      mesh_.repairs.push_back(counted(beams_, "beam") +
                              " of lattices not carried; export them as a mesh");
    if (!unread_extensions_.empty())
      mesh_.repairs.push_back(counted(unread_extensions_.size(), "required extension") +
                              " not read, such as " + *unread_extensions_.begin() +
                              "; compare the model with its source");
  }

  // Returns the part with this key, or nullptr if it is damaged. The first call for a key parses
  // the part.
  const ModelPart* part(const std::string& key, std::span<const std::uint8_t> bytes) {
    const auto [it, is_new] = parts_.try_emplace(key);
    if (!is_new) return it->second ? &*it->second : nullptr;
    room_ += bytes.size();
    if (!it->second.emplace().load(bytes)) it->second.reset();
    if (it->second) mesh_.translucent_colours += it->second->translucent_colours;
    return it->second ? &*it->second : nullptr;
  }

  // Adds the object to which an item or component refers. Applies the transform of the reference
  // and then `outer`.
  Expected<void> place(const ModelPart& from, const Node& reference, const Affine& outer,
                       int depth) {
    constexpr int kDeepest = 16;
    if (depth > kDeepest || ++placed_ > room_)
      return bad_input("the 3MF's components are in a cycle or too many; export the file again");
    const auto local = affine_of(reference);
    if (!local) return bad_input("a transform in the 3MF is damaged; export the file again");
    const std::string_view path = value_of(reference, "path"), id = value_of(reference, "objectid");
    const ModelPart* in = &from;
    if (!path.empty()) {
      const auto found = find_companion(options_.beside, {path});
      if (!found)
        return bad_input("the 3MF lacks its part " + in_quotes(path) + "; export it again");
      in = part((*found)->first, (*found)->second);
      if (in == nullptr) return damaged();
    }
    const auto object = in->objects.find(id);
    if (object == in->objects.end())
      return bad_input("the 3MF lacks its object " + in_quotes(id) + "; export it again");
    return add_object(*in, object->second, outer * *local, depth);
  }

  Expected<void> add_object(const ModelPart& in, const Node& object, const Affine& place_of_object,
                            int depth) {
    if (value_of(object, "type") == "support") return {};
    if (const Node mesh = object.child("mesh")) {
      const std::size_t first = mesh_.positions.size();
      count_beams(mesh);
      if (auto ok = add_vertices(mesh.child("vertices"), place_of_object); !ok) return ok;
      return add_triangles(in, object, first, place_of_object.mirrors());
    }
    for (const Node& component : object.child("components").children("component")) {
      if (auto ok = place(in, component, place_of_object, depth + 1); !ok) return ok;
    }
    return {};
  }

  // Counts the beams of lattices. The elements may have any namespace prefix.
  void count_beams(const Node& mesh) {
    for (const Node& lattice : mesh.children()) {
      if (local_name(lattice.name()) != "beamlattice") continue;
      for (const Node& beams : lattice.children()) {
        if (local_name(beams.name()) != "beams") continue;
        const auto all = beams.children();
        beams_ += static_cast<std::uint64_t>(std::distance(all.begin(), all.end()));
      }
    }
  }

  Expected<void> add_vertices(const Node& vertices, const Affine& place_of_object) {
    for (const Node& vertex : vertices.children("vertex")) {
      if (mesh_.positions.size() >= room_) return too_many();
      const auto x = parse_real(value_of(vertex, "x")), y = parse_real(value_of(vertex, "y")),
                 z = parse_real(value_of(vertex, "z"));
      if (!x || !y || !z)
        return bad_input("vertex " + std::to_string(mesh_.positions.size()) +
                         " of the 3MF lacks a coordinate; export the file again");
      mesh_.positions.push_back(place_of_object({*x, *y, *z}));
    }
    return {};
  }

  Expected<void> add_triangles(const ModelPart& in, const Node& object, std::size_t first,
                               bool is_mirrored) {
    const std::size_t count = mesh_.positions.size() - first;
    for (const Node& node : object.child("mesh").child("triangles").children("triangle")) {
      if (mesh_.face_count() >= room_) return too_many();
      Triangle triangle{};
      constexpr const char* kCorners[] = {"v1", "v2", "v3"};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = number_in<std::uint32_t>(node, kCorners[k]);
        if (!corner || *corner >= count)
          return bad_input("face " + std::to_string(mesh_.face_count()) +
                           " of the 3MF refers to a vertex that its object does not have");
        triangle[k] = static_cast<std::uint32_t>(first) + *corner;
      }
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      mesh_.add_triangle(triangle);
      painted_ += is_painted(node);
      colours_.add(triangle, colours_of(in, object, node));
    }
    return {};
  }

  // Returns the colours of a triangle's corners.
  std::array<StatedColour, 3> colours_of(const ModelPart& in, const Node& object,
                                         const Node& triangle) {
    constexpr std::array<StatedColour, 3> kNone = {kNoColour, kNoColour, kNoColour};
    std::string_view group = value_of(triangle, "pid");
    const bool is_own = !group.empty();
    if (!is_own) group = value_of(object, "pid");
    if (group.empty()) return kNone;
    const auto found = in.colours.find(group);
    if (found == in.colours.end()) return ++textured_, kNone;
    const std::optional<std::size_t> first =
        number_in<std::size_t>(is_own ? triangle : object, is_own ? "p1" : "pindex");
    std::array<StatedColour, 3> colours{};
    constexpr std::array<const char*, 3> kNames = {"p1", "p2", "p3"};
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      const auto index = is_own ? number_in<std::size_t>(triangle, kNames[k]) : first;
      const std::size_t i = index.value_or(first.value_or(0));
      if (i >= found->second.size()) return kNone;
      colours[k] = found->second[i];
    }
    has_colours_ = true;
    return colours;
  }

  static Unexpected too_many() {
    return fail(ErrorCode::kLimit,
                "the 3MF's components repeat too many triangles; export it as one object");
  }

  const ReadOptions& options_;
  std::map<std::string, std::optional<ModelPart>> parts_;
  // `room_` is the total size in bytes of all parts. The mesh gets at most this number of vertices
  // and of faces, even if its objects are repeated.
  std::uint64_t room_ = 0, placed_ = 0, textured_ = 0, beams_ = 0, painted_ = 0;
  std::set<std::string> unread_extensions_;  // names in quotes
  RawMesh mesh_;
  FaceColours colours_;
  bool has_colours_ = false;
};

}  // namespace

bool is_3mf(std::span<const std::uint8_t> bytes) {
  const std::string_view start = start_of(bytes);
  return start.find("<model") != start.npos && start.find("3dmanufacturing") != start.npos;
}

std::string_view unit_of_3mf(std::span<const std::uint8_t> bytes) {
  return unit_in(bytes).given;
}

Expected<RawMesh> read_3mf(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  return ThreeMfReader(options).read(bytes);
}

}  // namespace vitrine::inline codec
