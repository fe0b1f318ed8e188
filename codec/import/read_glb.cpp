// SPDX-License-Identifier: Apache-2.0
// Binary glTF 2.0: the triangles of all meshes of the scene, in the scene's coordinates.
#include <algorithm>
#include <array>
#include <map>

#include "codec/core/srgb.h"
#include "codec/import/affine.h"
#include "codec/import/byte_cursor.h"
#include "codec/import/gltf_buffer.h"
#include "codec/import/readers.h"
#include "codec/import/weld.h"

namespace vitrine {
namespace {

constexpr int kDeepestJson = 64;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

bool is_too_deep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') in_string = !in_string;
    if (in_string && c == '\\') ++i;
    if (in_string) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepestJson) return true;
  }
  return false;
}

// Numbers of a JSON array of exactly N, or `otherwise`.
template <std::size_t N>
std::array<double, N> numbers(const Json& array, std::array<double, N> otherwise) {
  if (!array.is_array() || array.size() != N) return otherwise;
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i) {
    if (!array[i].is_number()) return otherwise;
    out[i] = array[i].get<double>();
  }
  return out;
}

Affine transform_of(const Json& node) {
  if (const Json& matrix = member(node, "matrix"); matrix.is_array()) {
    const auto m =
        numbers<16>(matrix, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});  // column by column
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  const auto t = numbers<3>(member(node, "translation"), {0, 0, 0});
  const auto q = numbers<4>(member(node, "rotation"), {0, 0, 0, 1});
  const auto s = numbers<3>(member(node, "scale"), {1, 1, 1});
  return compose({t[0], t[1], t[2]}, q, {s[0], s[1], s[2]});
}

class GlbReader {
 public:
  GlbReader(std::span<const std::uint8_t> bytes, const Limits& limits)
      : bytes_(bytes), limits_(limits) {}

  Expected<RawMesh> read() {
    if (auto ok = split_chunks(); !ok) return Unexpected(ok.error());
    if (auto ok = check_extensions(); !ok) return Unexpected(ok.error());
    if (auto ok = read_scene(); !ok) return Unexpected(ok.error());
    return build();
  }

 private:
  static Unexpected bad(std::string what) {
    return bad_input("GLB: " + std::move(what) + "; the file is damaged, export it again");
  }

  Expected<void> split_chunks() {
    ByteCursor cursor(bytes_);
    cursor.skip(4);
    const auto version = cursor.read<std::uint32_t>();
    const auto length = cursor.read<std::uint32_t>();
    if (cursor.overrun()) return bad("the header is cut short");
    if (version != 2) {
      return fail(ErrorCode::kUnsupported,
                  "GLB version " + std::to_string(version) + " is not read; export glTF 2.0");
    }
    if (length > bytes_.size()) {
      return bad("the header claims " + counted(length, "byte") + ", the file has " +
                 std::to_string(bytes_.size()));
    }
    std::string_view json;
    for (std::size_t at = 12; at + 8 <= length;) {
      const auto size = load<std::uint32_t>(&bytes_[at]);
      const auto type = load<std::uint32_t>(&bytes_[at + 4]);
      if (size > length - at - 8) return bad("a chunk is cut short");
      const auto chunk = bytes_.subspan(at + 8, size);
      if (type == kJsonChunk && json.empty()) {
        json = {reinterpret_cast<const char*>(chunk.data()), size};
      }
      if (type == kBinaryChunk && buffer_.empty()) buffer_ = chunk;
      at += 8 + std::size_t{size};
    }
    return parse(json);
  }

  Expected<void> parse(std::string_view json) {
    if (json.size() > limits_.header_bytes) {
      return fail(ErrorCode::kLimit, "the GLB's JSON is " + counted(json.size(), "byte") +
                                         " long, too much; export the mesh alone");
    }
    if (is_too_deep(json)) return bad("the JSON is nested too deeply");
    document_ = Json::parse(json.begin(), json.end(), nullptr, false);
    if (!document_.is_object()) return bad("the JSON chunk is missing or not JSON");
    return {};
  }

  Expected<void> check_extensions() {
    for (const Json& name : member(document_, "extensionsRequired")) {
      const std::string text = name.is_string() ? name.get<std::string>() : std::string();
      if (text == "KHR_mesh_quantization" || text.starts_with("KHR_materials_") ||
          text.starts_with("KHR_texture_") || text.starts_with("EXT_texture_")) {
        continue;
      }
      return fail(ErrorCode::kUnsupported, "the GLB needs the extension " + in_quotes(text) +
                                               ", which is not read; export without it");
    }
    return {};
  }

  struct Visit {
    std::uint64_t node;
    Affine parent;
  };

  Expected<void> read_scene() {
    const Json& scene = element(document_, "scenes", whole(document_, "scene", 0));
    if (!scene.is_object()) return read_all_meshes();
    std::vector<Visit> open;
    const auto add = [&](const Json& nodes, const Affine& parent) {
      for (const Json& node : nodes) {
        open.push_back({node.is_number_unsigned() ? node.get<std::uint64_t>() : kAbsent, parent});
      }
    };
    const Json& nodes = member(document_, "nodes");
    std::vector<bool> seen(nodes.is_array() ? nodes.size() : 0, false);
    add(member(scene, "nodes"), Affine{});
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      if (visit.node >= seen.size()) return bad("a node does not exist");
      if (seen[visit.node]) return bad("node " + std::to_string(visit.node) + " has two parents");
      seen[visit.node] = true;
      const Json& node = nodes[visit.node];
      const Affine place = visit.parent * transform_of(node);
      if (const auto mesh = whole(node, "mesh", kAbsent); mesh != kAbsent) {
        if (auto ok = read_mesh_at(mesh, place); !ok) return ok;
      }
      add(member(node, "children"), place);
    }
    return {};
  }

  Expected<void> read_all_meshes() {
    const Json& meshes = member(document_, "meshes");
    for (std::uint64_t m = 0; meshes.is_array() && m < meshes.size(); ++m) {
      if (auto ok = read_mesh_at(m, Affine{}); !ok) return ok;
    }
    return {};
  }

  Expected<void> read_mesh_at(std::uint64_t mesh, const Affine& place) {
    shared_.clear();
    const Json& primitives = member(element(document_, "meshes", mesh), "primitives");
    if (!primitives.is_array()) return bad("mesh " + std::to_string(mesh) + " does not exist");
    for (const Json& primitive : primitives) {
      if (auto ok = read_primitive(primitive, place); !ok) return ok;
    }
    return {};
  }

  Expected<void> read_primitive(const Json& primitive, const Affine& place) {
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
      if (!member(member(primitive, "extensions"), name).is_null()) {
        return fail(ErrorCode::kUnsupported, "the GLB is compressed with " + std::string(name) +
                                                 ", which is not read; export without it");
      }
    }
    const std::uint64_t mode = whole(primitive, "mode", 4);
    if (mode < 4 || mode > 6) return ++skipped_primitives_, Expected<void>{};
    const Json& attributes = member(primitive, "attributes");
    const auto base = vertices_of(attributes, place);
    if (!base) return Unexpected(base.error());
    return read_faces(primitive, mode, *base, place.mirrors());
  }

  // The vertices of a primitive, which others of the same mesh may share: the first one's index
  // and their number.
  struct Range {
    std::uint32_t first, count;
  };

  Expected<Range> vertices_of(const Json& attributes, const Affine& place) {
    const std::uint64_t position = whole(attributes, "POSITION", kAbsent);
    const std::uint64_t colour = whole(attributes, "COLOR_0", kAbsent);
    has_seams_ = has_seams_ || attributes.contains("NORMAL") || attributes.contains("TEXCOORD_0");
    const auto [it, is_new] = shared_.try_emplace({position, colour});
    if (!is_new) return it->second;
    const auto points = Accessor::open(document_, buffer_, position);
    if (!points) return Unexpected(points.error());
    if (points->width() != 3) return bad("POSITION is not VEC3");
    if (auto ok = check_room(points->count()); !ok) return Unexpected(ok.error());
    it->second = {static_cast<std::uint32_t>(mesh_.positions.size()),
                  static_cast<std::uint32_t>(points->count())};
    for (std::uint64_t i = 0; i < points->count(); ++i) {
      mesh_.positions.push_back(
          place({points->real(i, 0), points->real(i, 1), points->real(i, 2)}));
    }
    if (colour != kAbsent) {
      if (auto ok = read_colours(colour, it->second); !ok) return Unexpected(ok.error());
    }
    return it->second;
  }

  // Instances may repeat what the file has once, but never to more vertices than it has bytes.
  Expected<void> check_room(std::uint64_t more) const {
    if (mesh_.positions.size() + more <= std::min<std::uint64_t>(bytes_.size(), limits_.vertices)) {
      return {};
    }
    return fail(ErrorCode::kLimit,
                "the GLB's instances make too many vertices; export the mesh without instances");
  }

  // glTF colours are linear light.
  Expected<void> read_colours(std::uint64_t index, const Range& range) {
    const auto colours = Accessor::open(document_, buffer_, index);
    if (!colours) return Unexpected(colours.error());
    if (colours->width() < 3 || colours->count() != range.count) {
      return bad("COLOR_0 does not match POSITION");
    }
    constexpr Colour kWhite{255, 255, 255};
    mesh_.colours.resize(range.first, kWhite);
    for (std::uint64_t i = 0; i < range.count; ++i) {
      Colour colour;
      for (std::uint32_t k = 0; k < 3; ++k) {
        colour[k] = to_byte(linear_to_srgb(colours->real(i, k)));
      }
      mesh_.colours.push_back(colour);
    }
    return {};
  }

  Expected<void> read_faces(const Json& primitive, std::uint64_t mode, const Range& range,
                            bool mirrored) {
    const std::uint64_t indices = whole(primitive, "indices", kAbsent);
    std::uint64_t count = range.count;
    Accessor accessor;
    if (indices != kAbsent) {
      const auto opened = Accessor::open(document_, buffer_, indices);
      if (!opened) return Unexpected(opened.error());
      if (opened->width() != 1 || !opened->is_whole()) return bad("the indices are not integers");
      accessor = *opened;
      count = accessor.count();
    }
    if (faces_.size() + count > bytes_.size() + 3) {
      return fail(ErrorCode::kLimit,
                  "the GLB's instances make too many faces; export the mesh without instances");
    }
    const auto at = [&](std::uint64_t i) -> std::uint64_t {
      const std::uint64_t v = indices == kAbsent ? i : accessor.index(i);
      return v < range.count ? range.first + v : kAbsent;
    };
    const std::uint64_t step = mode == 4 ? 3 : 1;
    for (std::uint64_t i = 0; i + 2 < count; i += step) {
      const bool odd = mode == 5 && i % 2 == 1;
      const std::uint64_t a = at(mode == 6 ? 0 : i), b = at(i + 1 + odd), c = at(i + 2 - odd);
      if (std::max({a, b, c}) == kAbsent) {
        return bad("face " + std::to_string(faces_.size()) +
                   " refers to a vertex that its "
                   "primitive does not have");
      }
      Triangle face{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                    static_cast<std::uint32_t>(c)};
      if (mirrored) std::swap(face[1], face[2]);
      faces_.push_back(face);
    }
    return {};
  }

  Expected<RawMesh> build() {
    if (!mesh_.colours.empty()) mesh_.colours.resize(mesh_.positions.size(), {255, 255, 255});
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

  // glTF repeats a vertex wherever its normal or texture coordinate jumps; neither is carried, so
  // the surface is whole again.
  void close_seams() {
    const std::size_t before = mesh_.positions.size();
    const std::vector<std::uint32_t> renamed = weld(mesh_.positions, mesh_.colours);
    if (mesh_.positions.size() == before) return;
    for (Triangle& face : faces_) {
      for (std::uint32_t& v : face)
        v = renamed[v];
    }
    mesh_.repairs.push_back(std::to_string(before - mesh_.positions.size()) +
                            " repeated vertices welded along seams of normals or textures");
  }

  std::span<const std::uint8_t> bytes_;
  const Limits& limits_;
  std::span<const std::uint8_t> buffer_;
  Json document_;
  RawMesh mesh_;
  std::vector<Triangle> faces_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Range> shared_;
  std::uint64_t skipped_primitives_ = 0;
  bool has_seams_ = false;
};

}  // namespace

Expected<RawMesh> read_glb(std::span<const std::uint8_t> bytes, const Limits& limits) {
  return GlbReader(bytes, limits).read();
}

}  // namespace vitrine
