// SPDX-License-Identifier: Apache-2.0
// Binary glTF 2.0: the triangles of all meshes of the scene, in the scene's coordinates.
#include <algorithm>
#include <map>
#include <tuple>

#include "codec/core/srgb.h"
#include "codec/import/draco_primitive.h"
#include "codec/import/glb_file.h"
#include "codec/import/gltf_accessor.h"
#include "codec/import/gltf_buffer.h"
#include "codec/import/gltf_scene.h"
#include "codec/import/readers.h"
#include "codec/import/weld.h"

namespace vitrine {
namespace {

constexpr Colour kWhite{255, 255, 255};

class GlbReader {
 public:
  GlbReader(const GlbFile& file, std::size_t file_bytes, const Limits& limits)
      : document_(file.document),
        buffer_(file.document, file.binary),
        file_bytes_(file_bytes),
        limits_(limits) {}

  Expected<RawMesh> read() {
    const auto placed = placed_meshes(document_);
    if (!placed) return Unexpected(placed.error());
    for (const PlacedMesh& mesh : *placed) {
      if (auto ok = read_mesh(mesh); !ok) return Unexpected(ok.error());
    }
    return build();
  }

 private:
  // The vertices of a primitive, which others of the same mesh may share: the first one's index
  // and their number.
  struct Range {
    std::uint32_t first, count;
  };
  // What makes the vertices of two primitives the same: compressed data, positions, colours.
  using VertexSource = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t>;

  Expected<void> read_mesh(const PlacedMesh& placed) {
    shared_.clear();
    const Json& primitives = member(element(document_, "meshes", placed.mesh), "primitives");
    if (!primitives.is_array()) {
      return bad_glb("mesh " + std::to_string(placed.mesh) + " does not exist");
    }
    for (const Json& primitive : primitives) {
      if (auto ok = read_primitive(primitive, placed.place); !ok) return ok;
    }
    return {};
  }

  Expected<void> read_primitive(const Json& primitive, const Affine& place) {
    const std::uint64_t mode = whole(primitive, "mode", 4);
    if (mode < 4 || mode > 6) return ++skipped_primitives_, Expected<void>{};
    const Json& compression = extension(primitive, "KHR_draco_mesh_compression");
    if (!compression.is_object()) {
      const auto range = vertices_of(primitive, nullptr, kAbsent, place);
      if (!range) return Unexpected(range.error());
      return read_faces(primitive, mode, *range, place.mirrors());
    }
    const std::uint64_t view = whole(compression, "bufferView", kAbsent);
    const auto decoded = decoded_at(view, primitive);
    if (!decoded) return Unexpected(decoded.error());
    const auto range = vertices_of(primitive, *decoded, view, place);
    if (!range) return Unexpected(range.error());
    return add_faces((*decoded)->faces.size(),
                     [&](std::uint64_t f) { return (*decoded)->faces[f]; }, *range,
                     place.mirrors());
  }

  Expected<const DracoPrimitive*> decoded_at(std::uint64_t index, const Json& primitive) {
    const auto [it, is_new] = decoded_.try_emplace(index);
    if (!is_new) return &it->second;
    const auto view = buffer_.view(index);
    if (!view) return Unexpected(view.error());
    auto decoded = decode_draco_primitive(view->bytes, document_, primitive, limits_);
    if (!decoded) return Unexpected(decoded.error());
    if (auto ok = buffer_.spend(decoded->bytes()); !ok) return Unexpected(ok.error());
    it->second = *std::move(decoded);
    return &it->second;
  }

  // The attribute's values: out of `decoded` where that holds them, else out of a buffer view.
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
    const std::uint64_t colour = whole(attributes, "COLOR_0", kAbsent);
    has_seams_ = has_seams_ || attributes.contains("NORMAL") || attributes.contains("TEXCOORD_0");
    const auto [it, is_new] =
        shared_.try_emplace({view, whole(attributes, "POSITION", kAbsent), colour});
    if (!is_new) return it->second;
    const auto points = attribute(primitive, "POSITION", decoded);
    if (!points) return Unexpected(points.error());
    if (points->width() != 3) return bad_glb("POSITION is not VEC3");
    if (auto ok = check_room(mesh_.positions.size() + points->count(), "vertices"); !ok) {
      return Unexpected(ok.error());
    }
    it->second = {static_cast<std::uint32_t>(mesh_.positions.size()),
                  static_cast<std::uint32_t>(points->count())};
    for (std::uint64_t i = 0; i < points->count(); ++i) {
      mesh_.positions.push_back(
          place({points->real(i, 0), points->real(i, 1), points->real(i, 2)}));
    }
    if (colour != kAbsent) {
      const auto colours = attribute(primitive, "COLOR_0", decoded);
      if (!colours) return Unexpected(colours.error());
      if (auto ok = add_colours(*colours, it->second); !ok) return Unexpected(ok.error());
    }
    return it->second;
  }

  // Instances may repeat what the file has once, but never to more than it has bytes.
  Expected<void> check_room(std::uint64_t count, const char* what) const {
    const std::uint64_t room = file_bytes_ + buffer_.spent() + 3;
    if (count <= std::min(room, limits_.faces)) return {};
    return fail(ErrorCode::kLimit, std::string("the GLB's instances make too many ") + what +
                                       "; export the mesh without instances");
  }

  // glTF colours are linear light.
  Expected<void> add_colours(const Accessor& colours, const Range& range) {
    if (colours.width() < 3 || colours.count() != range.count) {
      return bad_glb("COLOR_0 does not match POSITION");
    }
    mesh_.colours.resize(range.first, kWhite);
    for (std::uint64_t i = 0; i < range.count; ++i) {
      Colour colour;
      for (std::uint32_t k = 0; k < 3; ++k) {
        colour[k] = to_byte(linear_to_srgb(colours.real(i, k)));
      }
      mesh_.colours.push_back(colour);
    }
    return {};
  }

  Expected<void> read_faces(const Json& primitive, std::uint64_t mode, const Range& range,
                            bool mirrored) {
    const std::uint64_t indices = whole(primitive, "indices", kAbsent);
    has_seams_ =
        has_seams_ || (indices == kAbsent && mode == 4);  // every corner a vertex of its own
    std::uint64_t count = range.count;
    Accessor accessor;
    if (indices != kAbsent) {
      const auto opened = Accessor::open(document_, buffer_, indices);
      if (!opened) return Unexpected(opened.error());
      if (opened->width() != 1 || !opened->is_whole()) {
        return bad_glb("the indices are not integers");
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
    return add_faces(faces, face, range, mirrored);
  }

  // `face(f)` are the vertices of the f-th of `count` faces, numbered within `range`.
  template <class Face>
  Expected<void> add_faces(std::uint64_t count, const Face& face, const Range& range,
                           bool mirrored) {
    if (auto ok = check_room(faces_.size() + count, "faces"); !ok) return ok;
    for (std::uint64_t f = 0; f < count; ++f) {
      Triangle t = face(f);
      if (std::ranges::max(t) >= range.count) {
        return bad_glb("face " + std::to_string(faces_.size()) +
                       " refers to a vertex that its primitive does not have");
      }
      for (std::uint32_t& v : t)
        v += range.first;
      if (mirrored) std::swap(t[1], t[2]);
      faces_.push_back(t);
    }
    return {};
  }

  Expected<RawMesh> build() {
    if (!mesh_.colours.empty()) mesh_.colours.resize(mesh_.positions.size(), kWhite);
    if (has_seams_ && std::all_of(mesh_.positions.begin(), mesh_.positions.end(), is_usable)) {
      close_seams();
    }
    mesh_.reserve_faces(faces_.size());
    for (const Triangle& face : faces_)
      mesh_.add_triangle(face);
    if (const Json& images = member(document_, "images"); images.is_array() && !images.empty()) {
      mesh_.repairs.push_back(counted(images.size(), "texture map") + " not carried");
    }
    if (skipped_primitives_ > 0) {
      mesh_.repairs.push_back(counted(skipped_primitives_, "set") + " of points or lines dropped");
    }
    return std::move(mesh_);
  }

  // glTF repeats a vertex wherever its normal or texture coordinate jumps, and for each face where
  // there are no indices; none of these is carried, so the surface is whole again.
  void close_seams() {
    const std::size_t before = mesh_.positions.size();
    const std::vector<std::uint32_t> renamed = weld(mesh_.positions, mesh_.colours);
    if (mesh_.positions.size() == before) return;
    for (Triangle& face : faces_) {
      for (std::uint32_t& v : face)
        v = renamed[v];
    }
    mesh_.repairs.push_back(
        std::to_string(before - mesh_.positions.size()) +
        " repeated vertices welded, parted by normals, textures or missing indices");
  }

  const Json& document_;
  GltfBuffer buffer_;
  std::size_t file_bytes_;
  const Limits& limits_;
  RawMesh mesh_;
  std::vector<Triangle> faces_;
  std::map<VertexSource, Range> shared_;             // of the mesh that is being read
  std::map<std::uint64_t, DracoPrimitive> decoded_;  // by buffer view
  std::uint64_t skipped_primitives_ = 0;
  bool has_seams_ = false;
};

}  // namespace

Expected<RawMesh> read_glb(std::span<const std::uint8_t> bytes, const Limits& limits) {
  const auto file = open_glb(bytes, limits);
  if (!file) return Unexpected(file.error());
  return GlbReader(*file, bytes.size(), limits).read();
}

}  // namespace vitrine
