// SPDX-License-Identifier: Apache-2.0
// Reads glTF 2.0, as text or binary. The result contains the triangles of all meshes in the scene,
// in scene coordinates.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "codec/gltf/glb_file.h"
#include "codec/gltf/gltf_accessor.h"
#include "codec/gltf/gltf_base_colour.h"
#include "codec/gltf/gltf_buffer.h"
#include "codec/gltf/gltf_document.h"
#include "codec/gltf/gltf_instances.h"
#include "codec/gltf/gltf_materials.h"
#include "codec/gltf/gltf_pose.h"
#include "codec/gltf/gltf_scene.h"
#include "codec/import/readers.h"
#include "codec/import/stated_colours.h"

namespace vitrine::inline codec {
namespace {

constexpr Colour kWhite{255, 255, 255};

class GltfReader {
 public:
  GltfReader(const Json& document, std::span<const std::uint8_t> binary, std::size_t file_bytes,
             const ReadOptions& options)
      : document_(document),
        resources_(options.beside, file_bytes),
        buffer_(document, binary, resources_),
        pictures_(document, buffer_, resources_),
        base_colours_(document, pictures_, options.limits.pixels),
        materials_(document, pictures_, buffer_, options.limits),
        limits_(options.limits) {}

  Expected<RawMesh> read() {
    auto scene = read_scene(document_);
    if (!scene) return tl::unexpected(scene.error());
    places_ = std::move(scene->places);
    for (const MeshInstance& instance : scene->meshes) {
      if (auto ok = read_instances(instance); !ok) return tl::unexpected(ok.error());
    }
    return build();
  }

 private:
  // The vertices of a primitive: the index of the first one, their number, and whether they are
  // mirrored. Primitives of the same mesh may share their vertices.
  struct Range {
    std::uint32_t first, count;
    bool is_mirrored;
  };
  // Identifies the source of a primitive's vertices. The entries are the compressed data, the
  // positions, the joints, the colours, the base colour's coordinates, the material, the
  // coordinates of each kept set, and the morph targets. Primitives with equal sources share their
  // vertices.
  using VertexSource = std::vector<std::uint64_t>;

  // Reads the mesh of a node once for each copy of the node.
  Expected<void> read_instances(const MeshInstance& instance) {
    const auto copies = GltfInstances::open(document_, buffer_, instance.node);
    if (!copies) return tl::unexpected(copies.error());
    const auto joints = joints_at(instance.node);
    if (!joints) return tl::unexpected(joints.error());
    joints_ = *joints;
    weights_ = morph_weights(document_, instance);
    copies_ += copies->count();
    if (auto ok = check_room(copies_, "copies of a mesh"); !ok) return ok;
    for (std::uint64_t i = 0; i < copies->count(); ++i) {
      MeshInstance copy = instance;
      copy.place = instance.place * (*copies)[i];
      if (auto ok = read_mesh(copy); !ok) return ok;
    }
    return {};
  }

  // Returns the joints of a node's skin. Reads each skin only once.
  Expected<const Joints*> joints_at(std::uint64_t node) {
    const auto [it, is_new] =
        skins_.try_emplace(whole(element(document_, "nodes", node), "skin", kAbsent));
    if (!is_new) return &it->second;
    auto joints = joints_of(document_, buffer_, node, places_);
    if (!joints) return tl::unexpected(joints.error());
    it->second = *std::move(joints);
    return &it->second;
  }

  Expected<void> read_mesh(const MeshInstance& instance) {
    shared_.clear();
    const Json& primitives = member(element(document_, "meshes", instance.mesh), "primitives");
    if (!primitives.is_array()) {
      return bad_gltf("mesh " + std::to_string(instance.mesh) + " does not exist");
    }
    for (const Json& primitive : primitives) {
      if (auto ok = read_primitive(primitive, instance.place); !ok) return ok;
    }
    return {};
  }

  Expected<void> read_primitive(const Json& primitive, const Affine& place) {
    const std::uint64_t mode = whole(primitive, "mode", 4);
    if (mode < 4 || mode > 6) return skip(primitive), Expected<void>{};
    const Json& compression = extension(primitive, "KHR_draco_mesh_compression");
    if (!compression.is_object()) return read_plain(primitive, mode, place);
    const std::uint64_t view = whole(compression, "bufferView", kAbsent);
    const auto decoded = decoded_at(view, primitive);
    if (!decoded) return tl::unexpected(decoded.error());
    const auto range = vertices_of({.json = primitive, .decoded = *decoded}, view, place);
    if (!range) return tl::unexpected(range.error());
    return add_faces((*decoded)->faces.size(),
                     [&](std::uint64_t f) { return (*decoded)->faces[f]; }, *range);
  }

  // Reads a primitive that is not Draco-compressed.
  Expected<void> read_plain(const Json& primitive, std::uint64_t mode, const Affine& place) {
    const auto indices = indices_of(primitive);
    if (!indices) return tl::unexpected(indices.error());
    std::uint64_t needed = 0;
    for (std::uint64_t i = 0; *indices && i < (*indices)->count(); ++i)
      needed = std::max(needed, std::uint64_t{(*indices)->index(i)} + 1);
    const auto range = vertices_of({.json = primitive, .needed = needed}, kAbsent, place);
    if (!range) return tl::unexpected(range.error());
    const std::uint64_t corners = *indices ? (*indices)->count() : range->count;
    if (mode == 4 ? corners % 3 != 0 : corners < 3) incomplete_.insert(&primitive);
    return read_faces(*indices, mode, *range);
  }

  // Skips a primitive of points or lines, and counts the primitive and its points.
  void skip(const Json& primitive) {
    ++skipped_primitives_;
    const std::uint64_t index = whole(member(primitive, "attributes"), "POSITION", kAbsent);
    skipped_points_ += whole(element(document_, "accessors", index), "count", 0);
  }

  Expected<const DracoPrimitive*> decoded_at(std::uint64_t index, const Json& primitive) {
    const auto [it, is_new] = decoded_.try_emplace(index);
    if (!is_new) return &it->second;
    const auto view = buffer_.view(index);
    if (!view) return tl::unexpected(view.error());
    auto decoded = decode_draco_primitive(view->bytes, document_, primitive, limits_);
    if (!decoded) return tl::unexpected(decoded.error());
    if (auto ok = buffer_.spend(decoded->bytes()); !ok) return tl::unexpected(ok.error());
    it->second = *std::move(decoded);
    return &it->second;
  }

  // Opens an attribute of a primitive, and counts accessors that had to be corrected.
  Expected<Accessor> attribute(const GltfPrimitive& primitive, std::string_view name) {
    auto opened = primitive.open(document_, buffer_, name);
    if (opened && opened->is_corrected()) corrected_.insert(primitive.accessor(name));
    return opened;
  }

  Expected<Range> vertices_of(const GltfPrimitive& primitive, std::uint64_t view,
                              const Affine& place) {
    const Json& attributes = primitive.attributes();
    const BaseColour base = base_colours_.of(primitive.json);
    const std::uint16_t material = materials_.index_of(primitive.json);
    mesh_.use_material(material);
    // glTF stores a vertex twice if it has two normals or two pairs of texture coordinates.
    mesh_.has_seams =
        mesh_.has_seams || attributes.contains("NORMAL") || attributes.contains("TEXCOORD_0");
    const auto sets = coordinate_accessors(attributes, materials_[material]);
    const auto [it, is_new] = shared_.try_emplace(source_of(primitive, view, base, sets));
    if (!is_new) return it->second;
    const auto range = add_positions(primitive, place);
    if (!range) return range;
    it->second = *range;
    if (auto ok = add_colours(primitive, base, *range); !ok) return tl::unexpected(ok.error());
    note_coordinates(primitive, base, materials_[material]);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      if (sets[s] == kAbsent) continue;
      if (auto ok = add_coordinates(primitive, s, *range); !ok) return tl::unexpected(ok.error());
    }
    return range;
  }

  VertexSource source_of(const GltfPrimitive& primitive, std::uint64_t view, const BaseColour& base,
                         const std::array<std::uint64_t, kCoordinateSets>& sets) const {
    const bool has_picture = base.picture != nullptr;
    VertexSource out{view,
                     primitive.accessor("POSITION"),
                     primitive.accessor("JOINTS_0"),
                     primitive.accessor("COLOR_0"),
                     has_picture ? primitive.accessor(texcoord(base.texture.texcoord)) : kAbsent,
                     base.is_white() ? kAbsent : whole(primitive.json, "material", kAbsent)};
    out.insert(out.end(), sets.begin(), sets.end());
    if (weights_.empty()) return out;
    for (const Json& target : member(primitive.json, "targets"))
      out.push_back(whole(target, "POSITION", kAbsent));
    return out;
  }

  Expected<Range> add_positions(const GltfPrimitive& primitive, const Affine& place) {
    const auto points = attribute(primitive, "POSITION");
    if (!points) return tl::unexpected(points.error());
    if (points->width() != 3) return bad_gltf("POSITION is not VEC3");
    const std::size_t first = mesh_.positions.size();
    if (auto ok = check_room(first + points->count(), "vertices"); !ok)
      return tl::unexpected(ok.error());
    GltfPose pose(place, *joints_);
    if (auto ok = pose.read(document_, buffer_, primitive, points->count(), weights_); !ok)
      return tl::unexpected(ok.error());
    dropped_targets_ += pose.dropped_targets();
    grow_within(mesh_.positions, first + points->count(), room());
    for (std::uint64_t i = 0; i < points->count(); ++i)
      mesh_.positions.push_back(
          pose(i, {points->real(i, 0), points->real(i, 1), points->real(i, 2)}));
    return Range{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(points->count()),
                 pose.mirrors()};
  }

  static std::string texcoord(std::uint64_t n) { return "TEXCOORD_" + std::to_string(n); }

  // Returns the accessor of each set of texture coordinates that a map of the material uses. The
  // entries of other sets are kAbsent.
  static std::array<std::uint64_t, kCoordinateSets> coordinate_accessors(const Json& attributes,
                                                                         const Material& material) {
    std::array<std::uint64_t, kCoordinateSets> out;
    out.fill(kAbsent);
    for_each_map(material, [&](const TextureMap& map) {
      out[map.coordinates] = whole(attributes, texcoord(map.coordinates), kAbsent);
    });
    return out;
  }

  Expected<Accessor> coordinates(const GltfPrimitive& primitive, const std::string& name,
                                 const Range& range) {
    auto opened = attribute(primitive, name);
    if (opened && (opened->width() != 2 || opened->count() < range.count))
      return bad_gltf(name + " does not match POSITION");
    return opened;
  }

  Expected<void> add_coordinates(const GltfPrimitive& primitive, std::size_t set,
                                 const Range& range) {
    const auto places = coordinates(primitive, texcoord(set), range);
    if (!places) return tl::unexpected(places.error());
    std::vector<TextureCoordinates>& out = mesh_.vertex_coordinates[set];
    grow_within(out, std::size_t{range.first} + range.count, room());
    out.resize(range.first);
    for (std::uint64_t i = 0; i < range.count; ++i)
      out.push_back(
          {static_cast<float>(places->real(i, 0)), static_cast<float>(places->real(i, 1))});
    return {};
  }

  // Notes a primitive that lacks the coordinates of a texture map. Its vertices have the
  // coordinates (0, 0) instead, as in other programs.
  void note_coordinates(const GltfPrimitive& primitive, const BaseColour& base,
                        const Material& material) {
    bool lacks = base.picture != nullptr && !primitive.has(texcoord(base.texture.texcoord));
    for_each_map(material, [&](const TextureMap& map) {
      lacks = lacks || !primitive.has(texcoord(map.coordinates));
    });
    if (lacks) without_coordinates_.insert(&primitive.json);
  }

  // Limits the effect of repeated meshes: the result may have at most one vertex and one face per
  // byte of the file and its companions. Compressed data counts by its decompressed size.
  std::uint64_t room() const { return std::min(buffer_.bytes() + 3, limits_.faces); }

  Expected<void> check_room(std::uint64_t count, const char* what) const {
    if (count <= room()) return {};
    return fail(ErrorCode::kLimit, std::string("the glTF's instances make too many ") + what +
                                       "; export the mesh without instances");
  }

  // Sets each vertex colour to the product of the file's vertex colour, the material's factor and
  // the material's texture. The pixels of the texture are in sRGB, all other colours in linear
  // light.
  Expected<void> add_colours(const GltfPrimitive& primitive, const BaseColour& base,
                             const Range& range) {
    const bool has_colours = primitive.has("COLOR_0");
    if (!has_colours && base.is_white()) return {};
    Accessor colours;
    if (has_colours) {
      const auto opened = colours_of(primitive, range);
      if (!opened) return tl::unexpected(opened.error());
      colours = *opened;
    }
    std::optional<Accessor> places;
    const std::string set = texcoord(base.texture.texcoord);
    if (base.picture != nullptr && primitive.has(set)) {
      const auto opened = coordinates(primitive, set, range);
      if (!opened) return tl::unexpected(opened.error());
      places = *opened;
    }
    // An opaque material ignores the opacity of the colours.
    const bool has_opacity =
        has_colours && colours.width() == 4 &&
        materials_[materials_.index_of(primitive.json)].alpha_mode != AlphaMode::kOpaque;
    mesh_.is_baked = mesh_.is_baked || !base.is_white();
    if (base.factor != LinearColour{1, 1, 1})
      factors_.insert(whole(primitive.json, "material", kAbsent));
    const double scale = has_colours ? scale_of(primitive, colours, range) : 1;
    grow_within(mesh_.attributes.colours, std::size_t{range.first} + range.count, room());
    mesh_.attributes.colours.resize(range.first, kWhite);
    for (std::uint64_t i = 0; i < range.count; ++i) {
      LinearColour colour =
          places ? base.at(places->real(i, 0), places->real(i, 1)) : base.at(0, 0);
      if (has_colours) {
        colour = colour *
                 (LinearColour{colours.real(i, 0), colours.real(i, 1), colours.real(i, 2)} * scale);
        mesh_.translucent_colours += has_opacity && colours.real(i, 3) < 1;
      }
      mesh_.attributes.colours.push_back(to_srgb(colour));
    }
    return {};
  }

  // Opens the vertex colours. Exporters often forget to mark colours of 8 or 16 bits as normalised.
  Expected<Accessor> colours_of(const GltfPrimitive& primitive, const Range& range) {
    auto opened = attribute(primitive, "COLOR_0");
    if (!opened) return opened;
    if (opened->width() < 3 || opened->width() > 4 || opened->count() < range.count)
      return bad_gltf("COLOR_0 does not match POSITION");
    if (opened->normalise()) corrected_.insert(primitive.accessor("COLOR_0"));
    return opened;
  }

  // Returns the factor that scales the vertex colours to the range 0 to 1. Some exporters write
  // floats from 0 to 255. Counts values out of range.
  double scale_of(const GltfPrimitive& primitive, const Accessor& colours, const Range& range) {
    if (colours.is_whole()) return 1;
    std::vector<StatedColour> stated(range.count);
    for (std::uint64_t i = 0; i < range.count; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        // NaN counts as a negative number here, because the final colour is 0 for both.
        const double part = colours.real(i, k);
        stated[i][k] = std::isnan(part) ? -1.F : static_cast<float>(part);
      }
    }
    const bool is_wide = are_up_to_255(stated);
    for (const StatedColour& colour : stated)
      colour_faults_.count(colour, is_wide);
    if (is_wide) wide_colours_.insert(primitive.accessor("COLOR_0"));
    return is_wide ? 1.0 / 255 : 1.0;
  }

  // Returns the indices of a primitive, or nullopt if it has none.
  Expected<std::optional<Accessor>> indices_of(const Json& primitive) {
    const std::uint64_t indices = whole(primitive, "indices", kAbsent);
    if (indices == kAbsent) return std::nullopt;
    const auto opened = Accessor::open(document_, buffer_, indices);
    if (!opened) return tl::unexpected(opened.error());
    if (opened->width() != 1 || !opened->is_whole())
      return bad_gltf("the indices are not integers");
    if (opened->is_corrected()) corrected_.insert(indices);
    return *opened;
  }

  Expected<void> read_faces(const std::optional<Accessor>& indices, std::uint64_t mode,
                            const Range& range) {
    if (!indices && mode == 4) mesh_.has_seams = true;  // each corner has its own vertex
    const std::uint64_t count = indices ? indices->count() : range.count;
    const auto at = [&](std::uint64_t i) {
      return indices ? indices->index(i) : static_cast<std::uint32_t>(i);
    };
    const auto face = [&](std::uint64_t f) -> Triangle {
      if (mode == 4) return {at(3 * f), at(3 * f + 1), at(3 * f + 2)};
      const bool odd = mode == 5 && f % 2 == 1;
      return {at(mode == 6 ? 0 : f), at(f + 1 + odd), at(f + 2 - odd)};
    };
    const std::uint64_t faces = mode == 4 ? count / 3 : count < 3 ? 0 : count - 2;
    return add_faces(faces, face, range);
  }

  // Adds `count` faces. `face(f)` returns the indices of the three vertices of face f, relative to
  // the first vertex of `range`.
  template <class Face>
  Expected<void> add_faces(std::uint64_t count, const Face& face, const Range& range) {
    if (auto ok = check_room(mesh_.face_count() + count, "faces"); !ok) return ok;
    mesh_.grow_faces(mesh_.face_count() + count, room());
    for (std::uint64_t f = 0; f < count; ++f) {
      Triangle t = face(f);
      if (std::ranges::max(t) >= range.count) {
        return bad_gltf("face " + std::to_string(mesh_.face_count()) +
                        " refers to a vertex that its primitive does not have");
      }
      for (std::uint32_t& v : t)
        v += range.first;
      if (range.is_mirrored) std::swap(t[1], t[2]);
      mesh_.add_triangle(t);
    }
    return {};
  }

  Expected<RawMesh> build() {
    if (mesh_.positions.empty() && skipped_primitives_ > 0) return no_faces(skipped_points_);
    if (!mesh_.attributes.colours.empty())
      mesh_.attributes.colours.resize(mesh_.positions.size(), kWhite);
    materials_.give_to(mesh_);
    report();
    return std::move(mesh_);
  }

  void report() {
    std::vector<std::string>& lines = mesh_.repairs;
    const auto append = [&](const std::vector<std::string>& more) {
      lines.insert(lines.end(), more.begin(), more.end());
    };
    const std::uint64_t baked = base_colours_.decoded(), told = baked + pictures_.refused();
    if (baked > 0)
      lines.push_back(counted(baked, "texture map") +
                      " baked into vertex colours; no step is needed");
    append(pictures_.report());
    if (mesh_.materials.empty() && pictures_.count() > told)
      lines.push_back(counted(pictures_.count() - told, "texture map") +
                      " not carried; assign them to materials that the mesh uses");
    append(materials_.report());
    append(report_extensions(document_));
    if (!factors_.empty())
      lines.push_back("colours of " + counted(factors_.size(), "material") +
                      " baked into vertex colours; use texture maps to keep their borders sharp");
    if (skipped_primitives_ > 0)
      lines.push_back(counted(skipped_primitives_, "set") +
                      " of points or lines dropped; convert what you need to triangles");
    if (!wide_colours_.empty())
      lines.push_back(counted(wide_colours_.size(), "set") +
                      " of vertex colours read as 0 to 255; export colours from 0 to 1");
    append(colour_faults_.report());
    if (!without_coordinates_.empty())
      lines.push_back(counted(without_coordinates_.size(), "primitive") +
                      " without the coordinates of its texture map shows one pixel of the map; "
                      "export it with texture coordinates");
    if (!incomplete_.empty())
      lines.push_back(counted(incomplete_.size(), "primitive") +
                      " with a last face that lacks corners, which is not carried; compare the "
                      "model with its source");
    append(report_scene(document_));
    report_corrections();
  }

  void report_corrections() {
    std::vector<std::string>& lines = mesh_.repairs;
    if (!corrected_.empty())
      lines.push_back(
          counted(corrected_.size(), "accessor") +
          " with a wrong count, byte stride or normalisation corrected, first accessor " +
          std::to_string(*corrected_.begin()) + "; report it to the makers of the exporter");
    if (buffer_.clipped() > 0)
      lines.push_back(counted(buffer_.clipped(), "buffer view") +
                      " longer than its buffer read as far as the buffer goes; report it to the "
                      "makers of the exporter");
    if (dropped_targets_ > 0)
      lines.push_back(counted(dropped_targets_, "morph target") +
                      " not carried: the number of its values is not that of the vertices; export "
                      "the mesh with its shape keys applied");
    const Json& animations = member(document_, "animations");
    if (animations.is_array() && !animations.empty())
      lines.push_back(counted(animations.size(), "animation") +
                      " not carried; to show another pose, export the mesh in that pose");
  }

  const Json& document_;
  GltfResources resources_;
  GltfBuffer buffer_;
  GltfPictures pictures_;
  GltfBaseColours base_colours_;
  GltfMaterials materials_;
  const Limits& limits_;
  RawMesh mesh_;
  std::map<VertexSource, Range> shared_;             // vertices of the mesh that is being read
  std::map<std::uint64_t, DracoPrimitive> decoded_;  // key: index of the buffer view
  std::vector<Affine> places_;                       // transforms of the nodes (see GltfScene)
  std::map<std::uint64_t, Joints> skins_;            // key: index of the skin, or kAbsent
  const Joints* joints_ = nullptr;                   // joints of the node that is being read
  std::vector<double> weights_;                      // weights of the node's morph targets
  std::set<std::uint64_t> corrected_;                // indices of accessors that were corrected
  std::set<const Json*> without_coordinates_;        // primitives that lack texture coordinates
  std::set<const Json*> incomplete_;                 // primitives whose last face lacks corners
  std::set<std::uint64_t> wide_colours_;             // accessors of colours from 0 to 255
  ColourFaults colour_faults_;
  std::uint64_t copies_ = 0, dropped_targets_ = 0;
  std::uint64_t skipped_primitives_ = 0, skipped_points_ = 0;
  std::set<std::uint64_t> factors_;  // materials whose colours became vertex colours
};

Expected<RawMesh> read_document(std::string_view json, std::span<const std::uint8_t> binary,
                                std::size_t file_bytes, const ReadOptions& options) {
  const auto document = parse_gltf(json, options.limits);
  if (!document) return tl::unexpected(document.error());
  return GltfReader(*document, binary, file_bytes, options).read();
}

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool is_glb(std::span<const std::uint8_t> bytes) {
  return text_of(bytes).starts_with("glTF");
}

// A glTF document is a JSON object with the member "asset". A byte order mark may precede it.
// Tilesets of 3D Tiles have this member too, but no meshes. Scenes of Smithsonian Voyager state
// their own type in it.
bool is_gltf(std::span<const std::uint8_t> bytes) {
  const std::string_view text = text_of(bytes);
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const auto contains = [&](std::string_view part) { return text.find(part) != text.npos; };
  constexpr std::size_t kStart = 1024;
  return begin != text.npos && text[begin] == '{' && contains("\"asset\"") &&
         text.substr(0, kStart).find("si-dpo-3d") == text.npos &&
         (!contains("\"geometricError\"") || contains("\"meshes\""));
}

std::string_view unit_of_gltf(std::span<const std::uint8_t>) {
  return "m";
}

Expected<RawMesh> read_glb(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  const auto chunks = split_glb(bytes);
  if (!chunks) return tl::unexpected(chunks.error());
  return read_document(chunks->json, chunks->binary, bytes.size(), options);
}

Expected<RawMesh> read_gltf(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  return read_document(text_of(bytes), {}, bytes.size(), options);
}

}  // namespace vitrine::inline codec
