// SPDX-License-Identifier: Apache-2.0
// Reads COLLADA: the polygons of all geometries that the scene places, with their materials.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "codec/import/dae_document.h"
#include "codec/import/dae_materials.h"
#include "codec/import/readers.h"
#include "codec/import/scene_mesh.h"
#include "codec/import/text_cursor.h"
#include "codec/import/xml_names.h"
#include "codec/mesh/unit.h"

namespace vitrine::inline codec {
namespace {

using Text = std::string_view;

// the element "unit" begins within this number of bytes
constexpr std::size_t kDaeUnit = 1 << 16;

std::string_view start_of_dae(std::span<const std::uint8_t> bytes, std::size_t most) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), most)};
}

std::string_view root_of_dae(std::span<const std::uint8_t> bytes) {
  return root_name(start_of_dae(bytes, bytes.size()));
}

// Returns the length in metres of the unit that the element "unit" states. COLLADA prescribes
// metres if a file states no unit.
double metres_in(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kMeter = "meter=";
  const std::string_view root = root_of_dae(bytes);
  const std::string_view prefix = root.substr(0, root.size() - local_name(root).size());
  std::string_view text = start_of_dae(bytes, kDaeUnit);
  text.remove_prefix(std::min(text.find('<' + std::string(prefix) + "unit "), text.size()));
  text = text.substr(0, text.find('>'));
  const std::size_t meter = text.find(kMeter);
  if (meter == text.npos) return 1;
  text.remove_prefix(std::min(meter + kMeter.size() + 1, text.size()));
  return parse_real(text.substr(0, text.find_first_of("\"'"))).value_or(1);
}

int up_axis_of(const DaeNode& root) {
  const Text axis = root.child("asset").child_value("up_axis");
  return axis.find("Z_UP") != axis.npos ? 2 : axis.find("X_UP") != axis.npos ? 0 : 1;
}

// The values of an element "source", in rows.
struct DaeRows {
  std::span<const double> values;
  std::size_t stride = 1, count = 0;

  // Returns number k of row i, or 0 if there is none.
  double at(std::size_t i, std::size_t k) const {
    return i < count && k < stride ? values[i * stride + k] : 0;
  }
};

// Divides an array into the rows that an accessor describes. If the accessor states more rows than
// the array has, returns only the existing rows.
DaeRows rows_of(const DaeNode& accessor, std::span<const double> array) {
  const std::uint64_t first = whole_attribute(accessor, "offset", 0);
  const std::uint64_t stride = whole_attribute(accessor, "stride", 1);
  if (stride == 0 || first > array.size()) return {};
  const auto values = array.subspan(first);
  return {values, stride,
          std::min(values.size() / stride, whole_attribute(accessor, "count", SIZE_MAX))};
}

// An element "input". The number at `offset` in each corner is an index into `rows`.
struct DaeInput {
  std::size_t offset = 0;
  const DaeRows* rows = nullptr;
};

// The inputs of a primitive.
struct DaeInputs {
  std::size_t stride = 1;  // numbers per corner
  std::optional<std::size_t> vertex;
  DaeInput places, colours;
  std::uint64_t place_set = UINT64_MAX;
};

Affine rotation_about(const Vec3& axis, double degrees) {
  const double length = std::sqrt(dot(axis, axis));
  if (!(length > 0)) return {};
  const double half = degrees * std::numbers::pi / 360, s = std::sin(half) / length;
  return compose({}, {axis.x * s, axis.y * s, axis.z * s, std::cos(half)}, {1, 1, 1});
}

class DaeReader {
 public:
  DaeReader(const DaeDocument& document, std::span<const std::uint8_t> bytes,
            const ReadOptions& options)
      : document_(document),
        room_(bytes.size()),
        metres_(metres_in(bytes)),
        mesh_("DAE", options.beside, options.limits, room_),
        work_(room_),
        materials_(document, work_, mesh_.materials()) {}

  Expected<RawMesh> read() {
    const DaeNode root = document_.root();
    const Affine turn = to_y_up(up_axis_of(root), stated_length(metres_, 1).scale);
    const DaeNode scene = scene_of(root);
    for (const DaeNode& node : scene.children("node")) {
      if (auto ok = place(node, turn, turn, 0); !ok) return tl::unexpected(ok.error());
    }
    if (!mesh_.has_faces())
      return skipped_lines_ > 0 ? no_faces(mesh_.vertices())
                                : bad_input(
                                      "the DAE places no geometry with faces; export the "
                                      "model again");
    report();
    RawMesh out = std::move(mesh_).finish();
    out.translucent_colours = translucent_colours_;
    return out;
  }

 private:
  DaeNode scene_of(const DaeNode& root) const {
    const DaeNode scene =
        document_.find(root.child("scene").child("instance_visual_scene").attribute("url").value());
    return scene ? scene : root.child("library_visual_scenes").child("visual_scene");
  }

  // Returns the transform from a node's coordinates to its parent's coordinates.
  Affine transform_of(const DaeNode& node) {
    Affine out;
    for (const DaeNode& child : node.children()) {
      const Text kind = child.name();
      const auto n = numbers_in(child, 16);
      if (kind == "matrix" && n.size() == 16)
        out = out *
              Affine{
                  {n[0], n[4], n[8]}, {n[1], n[5], n[9]}, {n[2], n[6], n[10]}, {n[3], n[7], n[11]}};
      if (kind == "translate" && n.size() == 3) out = out * Affine{.origin = {n[0], n[1], n[2]}};
      if (kind == "scale" && n.size() == 3)
        out = out * Affine{{n[0], 0, 0}, {0, n[1], 0}, {0, 0, n[2]}, {}};
      if (kind == "rotate" && n.size() == 4) out = out * rotation_about({n[0], n[1], n[2]}, n[3]);
      if (kind == "lookat" || kind == "skew") ++skipped_transforms_;
    }
    return out;
  }

  // Adds the geometries that a node and its children place. `turn` maps scene coordinates to mesh
  // coordinates.
  Expected<void> place(const DaeNode& node, const Affine& outer, const Affine& turn, int depth) {
    constexpr int kDeepest = 64;
    if (depth > kDeepest || ++placed_ > room_)
      return bad_dae("its nodes are in a cycle, too deep or too many");
    const Affine here = outer * transform_of(node);
    for (const DaeNode& child : node.children()) {
      const bool is_node = child.name() == Text("node");
      if (auto ok = is_node ? place(child, here, turn, depth + 1)
                            : place_instance(child, here, turn, depth);
          !ok)
        return ok;
    }
    return {};
  }

  Expected<void> place_instance(const DaeNode& instance, const Affine& here, const Affine& turn,
                                int depth) {
    work_.add(DaeDocument::size_of(instance));
    if (auto ok = work_.check(); !ok) return ok;
    const Text kind = instance.name();
    const DaeNode target = document_.find(instance.attribute("url").value());
    if (kind == "instance_node") {
      missing_ += !target;
      return place(target, here, turn, depth + 1);
    }
    if (kind == "instance_geometry") return add_geometry(target, instance, here);
    if (kind == "instance_controller") return add_skinned(target, instance, turn, here, 0);
    return {};
  }

  // Adds the geometry of a controller in its bind pose. The transform of the node that places a
  // skin is ignored, because the joints place the skin.
  Expected<void> add_skinned(const DaeNode& controller, const DaeNode& instance, const Affine& turn,
                             const Affine& here, int depth) {
    constexpr int kMostControllers = 4;
    if (depth == kMostControllers) return bad_dae("its controllers are in a cycle");
    work_.add(DaeDocument::size_of(controller));
    const DaeNode skin = controller.child("skin"), morph = controller.child("morph");
    Affine at = here;
    if (skin) {
      ++skins_;
      const auto n = numbers_in(skin.child("bind_shape_matrix"), 16);
      at = turn;
      if (n.size() == 16)
        at = turn *
             Affine{
                 {n[0], n[4], n[8]}, {n[1], n[5], n[9]}, {n[2], n[6], n[10]}, {n[3], n[7], n[11]}};
    }
    if (morph) ++morphs_;
    const DaeNode source = document_.find((skin ? skin : morph).attribute("source").value());
    if (source.name() == Text("controller"))
      return add_skinned(source, instance, turn, at, depth + 1);
    return add_geometry(source, instance, at);
  }

  Expected<const DaeRows*> rows_at(Text url) {
    const DaeNode source = document_.find(url);
    const auto [it, is_new] = rows_.try_emplace(source.hash_value());
    if (!is_new) return &it->second;
    const DaeNode accessor = source.child("technique_common").child("accessor");
    const DaeNode array = document_.find(accessor.attribute("source").value());
    const auto values = values_of(array ? array : source.child("float_array"));
    if (!values) return tl::unexpected(values.error());
    it->second = rows_of(accessor, *values);
    return &it->second;
  }

  // Returns the numbers of an array. Parses each array once, because many sources may share it.
  Expected<std::span<const double>> values_of(const DaeNode& array) {
    const auto [it, is_new] = values_.try_emplace(array.hash_value());
    DaeNumbers text(is_new ? array : DaeNode());
    while (!text.is_done()) {
      const auto number = text.next<double>();
      if (!number) return bad_dae("an array has something besides numbers");
      it->second.push_back(*number);
    }
    return it->second;
  }

  Expected<void> add_geometry(const DaeNode& geometry, const DaeNode& instance,
                              const Affine& place_of_geometry) {
    work_.add(DaeDocument::size_of(geometry));
    const DaeNode mesh = geometry.child("mesh");
    if (!mesh) return ++missing_, Expected<void>();
    const DaeNode vertices = mesh.child("vertices");
    const DaeNode input = vertices.find_child_by_attribute("input", "semantic", "POSITION");
    const auto rows = rows_at(input.attribute("source").value());
    if (!rows) return tl::unexpected(rows.error());
    const DaeRows& positions = **rows;
    const std::size_t first = mesh_.vertices();
    for (std::size_t i = 0; i < positions.count; ++i) {
      const Vec3 p{positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)};
      if (auto ok = mesh_.add_vertex(place_of_geometry(p)); !ok) return ok;
    }
    materials_.bind(instance);
    geometry_ = {first, positions.count, place_of_geometry.mirrors()};
    for (const DaeNode& primitive : mesh.children()) {
      if (auto ok = add_primitive(primitive, vertices); !ok) return ok;
    }
    return {};
  }

  Expected<void> add_primitive(const DaeNode& primitive, const DaeNode& vertices) {
    const Text kind = primitive.name();
    if (kind == "lines" || kind == "linestrips") ++skipped_lines_;
    constexpr std::array<Text, 5> kKinds{"triangles", "polylist", "polygons", "trifans",
                                         "tristrips"};
    if (std::ranges::count(kKinds, kind) == 0) return {};
    const auto inputs = inputs_of(primitive, vertices);
    if (!inputs) return tl::unexpected(inputs.error());
    const auto material = materials_.define(primitive.attribute("material").value());
    if (auto ok = work_.check(); !ok) return ok;
    if (auto ok = mesh_.add_part(material); !ok) return ok;
    std::vector<DaeNode> lists(primitive.children("p").begin(), primitive.children("p").end());
    for (const DaeNode& with_holes : primitive.children("ph")) {
      ++holes_;
      lists.push_back(with_holes.child("p"));
    }
    DaeNumbers counts(primitive.child("vcount"));
    for (const DaeNode& list : lists) {
      if (auto ok = read_corners(list, *inputs); !ok) return ok;
      if (auto ok = add_faces(kind, counts); !ok) return ok;
    }
    return {};
  }

  Expected<DaeInputs> inputs_of(const DaeNode& primitive, const DaeNode& vertices) {
    constexpr std::uint64_t kMostNumbers = 256;
    DaeInputs out;
    for (const DaeNode& input : primitive.children("input")) {
      const std::uint64_t offset = whole_attribute(input, "offset", 0);
      if (offset >= kMostNumbers) return bad_dae("an input has an offset above 255");
      out.stride = std::max(out.stride, static_cast<std::size_t>(offset) + 1);
      if (input.attribute("semantic").value() == Text("VERTEX")) {
        out.vertex = offset;
        work_.add(DaeDocument::size_of(vertices));
        if (auto ok = work_.check(); !ok) return tl::unexpected(ok.error());
        for (const DaeNode& of_vertex : vertices.children("input")) {
          if (auto ok = take_input(of_vertex, offset, out); !ok) return tl::unexpected(ok.error());
        }
      } else if (auto ok = take_input(input, offset, out); !ok) {
        return tl::unexpected(ok.error());
      }
    }
    if (!out.vertex) return bad_dae("a primitive has no input VERTEX");
    return out;
  }

  // Stores an input of colours or texture coordinates in `out`. If there are several sets of
  // texture coordinates, keeps the set with the smallest number.
  Expected<void> take_input(const DaeNode& input, std::uint64_t offset, DaeInputs& out) {
    const Text semantic = input.attribute("semantic").value();
    if (semantic != "TEXCOORD" && semantic != "COLOR") return {};
    const auto rows = rows_at(input.attribute("source").value());
    if (!rows) return tl::unexpected(rows.error());
    const DaeInput read{static_cast<std::size_t>(offset), *rows};
    if (semantic == "COLOR") {
      if (out.colours.rows == nullptr) {
        out.colours = read;
        count_translucent(**rows);
      }
      return {};
    }
    const std::uint64_t set = whole_attribute(input, "set", 0);
    if (out.places.rows != nullptr) ++dropped_sets_;
    if (set >= out.place_set) return {};
    out.places = read;
    out.place_set = set;
    return {};
  }

  // Counts the colours in a source that are not fully opaque. Counts each source only once.
  void count_translucent(const DaeRows& colours) {
    constexpr std::size_t kOpacity = 3;
    if (colours.stride <= kOpacity || !colours_.insert(&colours).second) return;
    work_.add(colours.count);
    for (std::size_t i = 0; i < colours.count; ++i)
      translucent_colours_ += is_translucent(colours.at(i, kOpacity));
  }

  // Reads the corners of one list of indices into `corners_`.
  Expected<void> read_corners(const DaeNode& list, const DaeInputs& inputs) {
    corners_.clear();
    std::vector<std::int64_t> numbers(inputs.stride);
    DaeNumbers text(list);
    while (!text.is_done()) {
      for (std::int64_t& number : numbers) {
        const auto next = text.next<std::int64_t>();
        if (!next) return bad_dae("a list of indices has something else, or ends within a corner");
        number = *next;
      }
      const auto vertex = static_cast<std::uint64_t>(numbers[*inputs.vertex]);
      if (vertex >= geometry_.vertices)
        return bad_dae("a face refers to a vertex that its mesh does not have");
      corners_.push_back(
          corner(static_cast<std::uint32_t>(geometry_.first + vertex), numbers, inputs));
    }
    return {};
  }

  static SceneCorner corner(std::uint32_t vertex, const std::vector<std::int64_t>& numbers,
                            const DaeInputs& inputs) {
    SceneCorner out{.vertex = vertex};
    const auto value = [&](const DaeInput& input, std::size_t k) {
      return static_cast<float>(input.rows->at(static_cast<std::size_t>(numbers[input.offset]), k));
    };
    if (inputs.places.rows != nullptr)
      out.place = {value(inputs.places, 0), value(inputs.places, 1)};
    const DaeRows* colours = inputs.colours.rows;
    if (colours != nullptr &&
        static_cast<std::uint64_t>(numbers[inputs.colours.offset]) < colours->count)
      out.colour = {value(inputs.colours, 0), value(inputs.colours, 1), value(inputs.colours, 2)};
    return out;
  }

  // Adds the faces formed by the corners of one list. `counts` are the sizes of a polylist's faces.
  Expected<void> add_faces(Text kind, DaeNumbers& counts) {
    if (kind == "polygons") return add_face(corners_);
    if (kind == "polylist") return add_polylist(counts);
    if (kind == "triangles" && corners_.size() % 3 != 0)
      return bad_dae("a list of triangles ends within a face");
    const std::size_t step = kind == "triangles" ? 3 : 1;
    for (std::size_t i = 0; i + 3 <= corners_.size(); i += step) {
      std::array<SceneCorner, 3> face{corners_[i], corners_[i + 1], corners_[i + 2]};
      if (kind == "trifans") face[0] = corners_[0];
      if (kind == "tristrips" && i % 2 == 1) std::swap(face[1], face[2]);
      if (auto ok = add_face(face); !ok) return ok;
    }
    return {};
  }

  Expected<void> add_polylist(DaeNumbers& counts) {
    std::size_t begin = 0;
    while (!counts.is_done()) {
      const auto size = counts.next<std::uint32_t>();
      if (!size || *size > corners_.size() - begin)
        return bad_dae("a polylist has fewer corners than its vcount states");
      if (auto ok = add_face(std::span(corners_).subspan(begin, *size)); !ok) return ok;
      begin += *size;
    }
    if (begin < corners_.size())
      return bad_dae("a polylist has more corners than its vcount states");
    return {};
  }

  Expected<void> add_face(std::span<SceneCorner> corners) {
    return mesh_.add_face(corners, geometry_.is_mirrored);
  }

  void report() {
    if (missing_ > 0)
      mesh_.note(counted(missing_, "instance") + " dropped, because the file has no polygons for " +
                 (missing_ == 1 ? "it" : "them") +
                 "; convert curves to polygons, and export the whole scene to one file");
    if (skins_ > 0)
      mesh_.note(
          counted(skins_, "skin") +
          " not carried: the mesh is shown in its bind pose; to show another pose, apply the "
          "skin before exporting");
    if (morphs_ > 0)
      mesh_.note(counted(morphs_, "morph controller") +
                 " not carried; apply the shape before exporting");
    if (const auto animations = document_.count("animation"); animations > 0)
      mesh_.note(counted(animations, "animation") +
                 " not carried; to show another pose, export the mesh in that pose");
    if (dropped_sets_ > 0)
      mesh_.note(counted(dropped_sets_, "further set") +
                 " of texture coordinates not carried; bake the maps that use them into the first "
                 "set");
    if (skipped_lines_ > 0)
      mesh_.note(counted(skipped_lines_, "set") +
                 " of points or lines dropped; convert what you need to triangles");
    if (holes_ > 0)
      mesh_.note(counted(holes_, "hole") +
                 " in polygons closed; cut the polygons into triangles before exporting");
    if (skipped_transforms_ > 0)
      mesh_.note(counted(skipped_transforms_, "transform") +
                 " of the kinds lookat and skew ignored; apply the transforms before exporting");
  }

  // The vertices of the geometry that is being added.
  struct GeometryVertices {
    std::size_t first = 0, vertices = 0;
    bool is_mirrored = false;
  };

  const DaeDocument& document_;
  std::uint64_t room_;
  double metres_;
  SceneMesh mesh_;
  DaeWork work_;
  DaeMaterials materials_;
  std::map<std::size_t, std::vector<double>> values_;  // key: hash value of the array's node
  std::map<std::size_t, DaeRows> rows_;                // key: hash value of the source's node
  std::set<const DaeRows*> colours_;                   // sources whose colours have been counted
  std::vector<SceneCorner> corners_;
  GeometryVertices geometry_;
  std::uint64_t placed_ = 0, skins_ = 0, morphs_ = 0, dropped_sets_ = 0, skipped_lines_ = 0,
                holes_ = 0, skipped_transforms_ = 0, missing_ = 0, translucent_colours_ = 0;
};

}  // namespace

bool is_dae(std::span<const std::uint8_t> bytes) {
  return local_name(root_of_dae(bytes)) == "COLLADA";
}

std::string_view unit_of_dae(std::span<const std::uint8_t> bytes) {
  return stated_length(metres_in(bytes), 1).unit;
}

Expected<RawMesh> read_dae(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  const auto document = DaeDocument::parse(bytes);
  if (!document) return tl::unexpected(document.error());
  return DaeReader(*document, bytes, options).read();
}

}  // namespace vitrine::inline codec
