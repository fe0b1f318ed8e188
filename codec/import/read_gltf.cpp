// SPDX-License-Identifier: Apache-2.0
// Reads glTF 2.0 as text or binary: the triangles of all meshes in the scene, in the scene's
// coordinates.
#include <algorithm>
#include <array>
#include <map>

#include "codec/gltf/draco_primitive.h"
#include "codec/gltf/glb_file.h"
#include "codec/gltf/gltf_accessor.h"
#include "codec/gltf/gltf_base_colour.h"
#include "codec/gltf/gltf_buffer.h"
#include "codec/gltf/gltf_document.h"
#include "codec/gltf/gltf_materials.h"
#include "codec/gltf/gltf_scene.h"
#include "codec/import/readers.h"

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
    const auto instances = mesh_instances(document_);
    if (!instances) return tl::unexpected(instances.error());
    for (const MeshInstance& instance : *instances) {
      if (auto ok = read_mesh(instance); !ok) return tl::unexpected(ok.error());
    }
    return build();
  }

 private:
  // The vertices of a primitive: index of the first one, and their number. Primitives of the same
  // mesh may share them.
  struct Range {
    std::uint32_t first, count;
  };
  // The source of a primitive's vertices: indices of the compressed data, positions, colours, the
  // base colour's coordinates, the material, and the coordinates of each carried set. Primitives
  // with equal sources share their vertices.
  using VertexSource = std::array<std::uint64_t, 5 + kCoordinateSets>;

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
    if (!compression.is_object()) {
      const auto range = vertices_of(primitive, nullptr, kAbsent, place);
      if (!range) return tl::unexpected(range.error());
      return read_faces(primitive, mode, *range, place.mirrors());
    }
    const std::uint64_t view = whole(compression, "bufferView", kAbsent);
    const auto decoded = decoded_at(view, primitive);
    if (!decoded) return tl::unexpected(decoded.error());
    const auto range = vertices_of(primitive, *decoded, view, place);
    if (!range) return tl::unexpected(range.error());
    return add_faces((*decoded)->faces.size(),
                     [&](std::uint64_t f) { return (*decoded)->faces[f]; }, *range,
                     place.mirrors());
  }

  // Counts a primitive of points or lines, and its points, instead of reading it.
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

  // Returns the values of an attribute: from `decoded` if that has them, otherwise from a buffer
  // view.
  Expected<Accessor> attribute(const Json& primitive, const std::string& name,
                               const DracoPrimitive* decoded) {
    const std::uint64_t index = whole(member(primitive, "attributes"), name, kAbsent);
    if (decoded != nullptr) {
      const auto it = decoded->values.find(name);
      if (it != decoded->values.end()) return Accessor::over(document_, it->second, index);
    }
    return Accessor::open(document_, buffer_, index);
  }

  Expected<Range> vertices_of(const Json& primitive, const DracoPrimitive* decoded,
                              std::uint64_t view, const Affine& place) {
    const Json& attributes = member(primitive, "attributes");
    const BaseColour base = base_colours_.of(primitive);
    const std::uint16_t material = materials_.index_of(primitive);
    mesh_.use_material(material);
    // glTF repeats a vertex where its normal or texture coordinate is discontinuous.
    mesh_.has_seams =
        mesh_.has_seams || attributes.contains("NORMAL") || attributes.contains("TEXCOORD_0");
    const auto sets = coordinate_accessors(attributes, materials_[material]);
    const auto [it, is_new] = shared_.try_emplace(source_of(primitive, view, base, sets));
    if (!is_new) return it->second;
    const auto range = add_positions(primitive, decoded, place);
    if (!range) return range;
    it->second = *range;
    if (auto ok = add_colours(primitive, decoded, base, *range); !ok)
      return tl::unexpected(ok.error());
    for (std::size_t s = 0; s < sets.size(); ++s) {
      if (sets[s] == kAbsent) continue;
      if (auto ok = add_coordinates(primitive, decoded, s, *range); !ok)
        return tl::unexpected(ok.error());
    }
    return range;
  }

  static VertexSource source_of(const Json& primitive, std::uint64_t view, const BaseColour& base,
                                const std::array<std::uint64_t, kCoordinateSets>& sets) {
    const Json& attributes = member(primitive, "attributes");
    const auto accessor = [&](const std::string& name) { return whole(attributes, name, kAbsent); };
    return {view,
            accessor("POSITION"),
            accessor("COLOR_0"),
            base.picture == nullptr ? kAbsent : accessor(texcoord(base.texture.texcoord)),
            base.is_white() ? kAbsent : whole(primitive, "material", kAbsent),
            sets[0],
            sets[1]};
  }

  Expected<Range> add_positions(const Json& primitive, const DracoPrimitive* decoded,
                                const Affine& place) {
    const auto points = attribute(primitive, "POSITION", decoded);
    if (!points) return tl::unexpected(points.error());
    if (points->width() != 3) return bad_gltf("POSITION is not VEC3");
    const std::size_t first = mesh_.positions.size();
    if (auto ok = check_room(first + points->count(), "vertices"); !ok)
      return tl::unexpected(ok.error());
    grow_within(mesh_.positions, first + points->count(), room());
    for (std::uint64_t i = 0; i < points->count(); ++i) {
      mesh_.positions.push_back(
          place({points->real(i, 0), points->real(i, 1), points->real(i, 2)}));
    }
    return Range{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(points->count())};
  }

  static std::string texcoord(std::uint64_t n) { return "TEXCOORD_" + std::to_string(n); }

  // Returns for each set that a map of the material uses the accessor of its coordinates, or
  // kAbsent.
  static std::array<std::uint64_t, kCoordinateSets> coordinate_accessors(const Json& attributes,
                                                                         const Material& material) {
    std::array<std::uint64_t, kCoordinateSets> out;
    out.fill(kAbsent);
    for_each_map(material, [&](const TextureMap& map) {
      out[map.coordinates] = whole(attributes, texcoord(map.coordinates), kAbsent);
    });
    return out;
  }

  Expected<Accessor> coordinates(const Json& primitive, const DracoPrimitive* decoded,
                                 const std::string& name, const Range& range) {
    auto opened = attribute(primitive, name, decoded);
    if (opened && (opened->width() != 2 || opened->count() != range.count))
      return bad_gltf(name + " does not match POSITION");
    return opened;
  }

  Expected<void> add_coordinates(const Json& primitive, const DracoPrimitive* decoded,
                                 std::size_t set, const Range& range) {
    const auto places = coordinates(primitive, decoded, texcoord(set), range);
    if (!places) return tl::unexpected(places.error());
    std::vector<TextureCoordinates>& out = mesh_.vertex_coordinates[set];
    grow_within(out, std::size_t{range.first} + range.count, room());
    out.resize(range.first);
    for (std::uint64_t i = 0; i < range.count; ++i)
      out.push_back(
          {static_cast<float>(places->real(i, 0)), static_cast<float>(places->real(i, 1))});
    return {};
  }

  // Bounds the effect of instances: the result must not have more elements than the file and its
  // companions have bytes after decompression.
  std::uint64_t room() const { return std::min(buffer_.bytes() + 3, limits_.faces); }

  Expected<void> check_room(std::uint64_t count, const char* what) const {
    if (count <= room()) return {};
    return fail(ErrorCode::kLimit, std::string("the glTF's instances make too many ") + what +
                                       "; export the mesh without instances");
  }

  // Sets the colours to the product of vertex colour, factor and texture. All of these are in
  // linear light except the pixels of the texture.
  Expected<void> add_colours(const Json& primitive, const DracoPrimitive* decoded,
                             const BaseColour& base, const Range& range) {
    const Json& attributes = member(primitive, "attributes");
    const bool has_colours = attributes.contains("COLOR_0");
    if (!has_colours && base.is_white()) return {};
    Accessor colours, places;
    if (has_colours) {
      const auto opened = attribute(primitive, "COLOR_0", decoded);
      if (!opened) return tl::unexpected(opened.error());
      if (opened->width() < 3 || opened->count() != range.count) {
        return bad_gltf("COLOR_0 does not match POSITION");
      }
      colours = *opened;
    }
    if (base.picture != nullptr) {
      const std::string name = texcoord(base.texture.texcoord);
      if (!attributes.contains(name)) return bad_gltf("a textured primitive lacks " + name);
      const auto opened = coordinates(primitive, decoded, name, range);
      if (!opened) return tl::unexpected(opened.error());
      places = *opened;
    }
    mesh_.is_baked = mesh_.is_baked || !base.is_white();
    has_factors_ = has_factors_ || base.factor != LinearColour{1, 1, 1};
    grow_within(mesh_.attributes.colours, std::size_t{range.first} + range.count, room());
    mesh_.attributes.colours.resize(range.first, kWhite);
    for (std::uint64_t i = 0; i < range.count; ++i) {
      LinearColour colour =
          base.picture == nullptr ? base.factor : base.at(places.real(i, 0), places.real(i, 1));
      if (has_colours) {
        colour = colour * LinearColour{colours.real(i, 0), colours.real(i, 1), colours.real(i, 2)};
      }
      mesh_.attributes.colours.push_back(to_srgb(colour));
    }
    return {};
  }

  Expected<void> read_faces(const Json& primitive, std::uint64_t mode, const Range& range,
                            bool is_mirrored) {
    const std::uint64_t indices = whole(primitive, "indices", kAbsent);
    if (indices == kAbsent && mode == 4) mesh_.has_seams = true;  // each corner has its own vertex
    std::uint64_t count = range.count;
    Accessor accessor;
    if (indices != kAbsent) {
      const auto opened = Accessor::open(document_, buffer_, indices);
      if (!opened) return tl::unexpected(opened.error());
      if (opened->width() != 1 || !opened->is_whole()) {
        return bad_gltf("the indices are not integers");
      }
      accessor = *opened;
      count = accessor.count();
    }
    const auto at = [&](std::uint64_t i) {
      return indices == kAbsent ? static_cast<std::uint32_t>(i) : accessor.index(i);
    };
    const auto face = [&](std::uint64_t f) -> Triangle {
      if (mode == 4) return {at(3 * f), at(3 * f + 1), at(3 * f + 2)};
      const bool odd = mode == 5 && f % 2 == 1;
      return {at(mode == 6 ? 0 : f), at(f + 1 + odd), at(f + 2 - odd)};
    };
    const std::uint64_t faces = mode == 4 ? count / 3 : count < 3 ? 0 : count - 2;
    return add_faces(faces, face, range, is_mirrored);
  }

  // Adds `count` faces. `face(f)` returns the three vertices of face f, numbered from 0 within
  // `range`.
  template <class Face>
  Expected<void> add_faces(std::uint64_t count, const Face& face, const Range& range,
                           bool is_mirrored) {
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
      if (is_mirrored) std::swap(t[1], t[2]);
      mesh_.add_triangle(t);
    }
    return {};
  }

  Expected<RawMesh> build() {
    if (mesh_.positions.empty() && skipped_primitives_ > 0) return no_faces(skipped_points_);
    if (!mesh_.attributes.colours.empty())
      mesh_.attributes.colours.resize(mesh_.positions.size(), kWhite);
    report();
    materials_.give_to(mesh_);
    return std::move(mesh_);
  }

  void report() {
    std::vector<std::string>& lines = mesh_.repairs;
    const auto append = [&](const std::vector<std::string>& more) {
      lines.insert(lines.end(), more.begin(), more.end());
    };
    const std::uint64_t baked = base_colours_.decoded(), told = baked + pictures_.refused();
    if (baked > 0) lines.push_back(counted(baked, "texture map") + " baked into vertex colours");
    append(pictures_.report());
    if (pictures_.count() > told)
      lines.push_back(counted(pictures_.count() - told, "texture map") + " not carried");
    append(materials_.report());
    if (has_factors_) lines.emplace_back("material colours baked into vertex colours");
    if (skipped_primitives_ > 0)
      lines.push_back(counted(skipped_primitives_, "set") + " of points or lines dropped");
  }

  const Json& document_;
  GltfResources resources_;
  GltfBuffer buffer_;
  GltfPictures pictures_;
  GltfBaseColours base_colours_;
  GltfMaterials materials_;
  const Limits& limits_;
  RawMesh mesh_;
  std::map<VertexSource, Range> shared_;             // vertices of the mesh being read
  std::map<std::uint64_t, DracoPrimitive> decoded_;  // key: index of the buffer view
  std::uint64_t skipped_primitives_ = 0, skipped_points_ = 0;
  bool has_factors_ = false;
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

// Every glTF document is a JSON object with the member "asset".
bool is_gltf(std::span<const std::uint8_t> bytes) {
  const std::string_view text = text_of(bytes);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin != text.npos && text[begin] == '{' && text.find("\"asset\"") != text.npos;
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
