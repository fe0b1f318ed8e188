// SPDX-License-Identifier: Apache-2.0
// Writes binary glTF 2.0 [glTF]: one mesh with a primitive for each material in use. Colours are
// stored in linear light, from which every sRGB byte can be restored exactly. If the mesh is far
// from the origin, or compression rounds its positions, the positions are stored relative to the
// node's translation. The translation is decimal text, so it has more digits than a float. A
// textured mesh has texture coordinates instead of colours, and its pictures are in the file. All
// vertices into which a seam splits a vertex have the same normal.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "codec/export/draco_primitive_writer.h"
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/glb_description.h"
#include "codec/export/glb_material.h"
#include "codec/export/glb_streams.h"
#include "codec/export/meshopt_streams.h"
#include "codec/export/seam_vertices.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

// The faces that use a material: `count` consecutive faces of the file, from index `first` on.
struct Primitive {
  std::uint16_t material = 0;
  std::size_t first = 0, count = 0;
};

std::size_t padded(std::size_t bytes) {
  return (bytes + 3) / 4 * 4;
}

void put_vector(FileWriter& json, const Vec3& v) {
  json.text("["), json.numbers<double>(v, ","), json.text("]");
}

// Writes a vector, with as many digits as single precision needs.
void put_floats(FileWriter& json, const Vec3& v) {
  json.text("["), json.numbers<float>(v, ","), json.text("]");
}

std::string_view element_type_of(const GlbStream& stream) {
  constexpr std::string_view kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kTypes[stream.components - 1];
}

SeamVertices unsplit(const TriangleMesh& mesh) {
  SeamVertices all{.faces = mesh.faces, .original = {}, .coordinates = {}};
  all.original.resize(mesh.positions.size());
  std::iota(all.original.begin(), all.original.end(), 0u);
  return all;
}

class GlbFile {
 public:
  GlbFile(const TriangleMesh& mesh, const Texturing& texturing, std::span<const Vec3> normals,
          const ExportOptions& options)
      : mesh_(mesh), texturing_(texturing), normals_(normals), options_(options) {
    vertices_ = texturing.empty() ? unsplit(mesh) : split_at_seams(mesh, texturing);
    primitives_ = {{.count = mesh.faces.size()}};
    if (!texturing.empty()) order_by_material();
    find_place();
  }

  Expected<FileBytes> write() {
    if (auto ok = make_streams(); !ok) return tl::unexpected(ok.error());
    const FileBytes json = this->json();
    const std::size_t binary = binary_bytes(), total = 12 + 8 + json.size() + 8 + binary;
    FileWriter out(total);
    out.text("glTF");
    out.put(std::uint32_t{2});
    out.put(static_cast<std::uint32_t>(total));
    out.put(static_cast<std::uint32_t>(json.size()));
    out.text("JSON");
    out.text({reinterpret_cast<const char*>(json.data()), json.size()});
    out.put(static_cast<std::uint32_t>(binary));
    out.text({"BIN\0", 4});
    for (const FileBytes* bytes : blocks()) {
      out.text({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
      out.text({"\0\0\0", padded(bytes->size()) - bytes->size()});
    }
    return out.take();
  }

 private:
  bool is_draco() const { return options_.compression == Compression::kDraco; }
  bool is_meshopt() const { return options_.compression == Compression::kMeshopt; }

  // Sorts the faces by material, and finds the faces of each material.
  void order_by_material() {
    std::vector<std::uint32_t> order(mesh_.faces.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto material_of = [&](std::uint32_t f) { return texturing_.face_materials[f]; };
    std::ranges::stable_sort(order, {}, material_of);
    std::vector<Triangle> faces;
    primitives_.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::uint16_t material = material_of(order[i]);
      if (i == 0 || primitives_.back().material != material)
        primitives_.push_back({.material = material, .first = i});
      ++primitives_.back().count;
      faces.push_back(vertices_.faces[order[i]]);
    }
    vertices_.faces = std::move(faces);
  }

  // Chooses the point to which stored positions are relative. For exact positions, this is the
  // origin, or the centre of the bounding box if the box is far from the origin. For positions
  // rounded without a grid, it is the lower corner of the box. With a grid, it is the grid point at
  // or below that corner. For meshopt, also sets scale_ if all grid coordinates fit into 16 bits.
  void find_place() {
    const Bounds box = bounds_of(mesh_.positions);
    if (options_.compression == Compression::kNone || (is_meshopt() && !options_.grid)) {
      if (is_far_from_origin(box)) place_ = box.centre();
      return;
    }
    place_ = box.low;
    if (!options_.grid) return;
    const Vec3 origin = options_.grid->origin;
    const double step = options_.grid->step;
    const auto on_grid = [&](double low, double start) {
      return start + std::floor((low - start) / step) * step;
    };
    place_ = {on_grid(box.low.x, origin.x), on_grid(box.low.y, origin.y),
              on_grid(box.low.z, origin.z)};
    const Vec3 side = box.high - place_;
    const bool is_small = std::ceil(std::max({side.x, side.y, side.z}) / step) <= 65535;
    if (is_meshopt() && is_small) scale_ = step;
  }

  Expected<void> make_streams() {
    if (is_meshopt()) order_for_meshopt(vertices_);
    const GlbSource source{.mesh = mesh_,
                           .normals = normals_,
                           .vertices = vertices_,
                           .is_textured = !texturing_.empty(),
                           .place = place_};
    if (is_meshopt()) {
      streams_ = packed_streams(source, options_.grid, scale_.has_value());
      for (GlbStream& stream : streams_)
        compress_attribute(stream);
    } else {
      streams_ = exact_streams(source);
    }
    streams_.push_back(index_stream(vertices_));
    if (is_meshopt()) compress_indices(streams_.back(), vertices_);
    return is_draco() ? compress_with_draco() : Expected<void>();
  }

  Expected<void> compress_with_draco() {
    const std::span attributes(streams_.data(), streams_.size() - 1);
    auto compressed =
        compress_primitive(attributes, vertices_.faces, options_.grid ? options_.grid->step : 0);
    if (!compressed) return tl::unexpected(compressed.error());
    for (GlbStream& stream : streams_) {
      stream.count = compressed->points;
      stream.bytes.clear();
    }
    streams_.back().count = compressed->faces * 3;
    primitives_.front().count = compressed->faces;
    draco_ = std::move(compressed->bytes);
    return {};
  }

  // Returns the blocks of the binary chunk. Each block is the content of one buffer view.
  std::vector<const FileBytes*> blocks() const {
    std::vector<const FileBytes*> all;
    if (is_draco()) {
      all.push_back(&draco_);
    } else {
      for (const GlbStream& stream : streams_)
        all.push_back(&stream.bytes);
    }
    for (const EncodedPicture& picture : texturing_.pictures)
      all.push_back(&picture.bytes);
    return all;
  }

  std::size_t binary_bytes() const {
    std::size_t bytes = 0;
    for (const FileBytes* block : blocks())
      bytes += padded(block->size());
    return bytes;
  }

  FileBytes json() const {
    FileWriter out(8192);
    GlbExtensions extensions;
    out.text("{"), put_asset(out, options_, extensions);
    out.text(R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)");
    put_name(out, options_.about);
    if (place_ != Vec3{}) out.text(R"(,"translation":)"), put_vector(out, place_);
    if (scale_) out.text(R"(,"scale":)"), put_vector(out, {*scale_, *scale_, *scale_});
    out.text(R"(}],"meshes":[{"primitives":[)");
    for (std::size_t i = 0; i < primitives_.size(); ++i)
      out.text(i == 0 ? "" : ","), put_primitive(out, i);
    out.text("]"), put_name(out, options_.about, level_part()), out.text("}],");
    if (texturing_.empty()) {
      out.text(R"("materials":[{"doubleSided":true,)"
               R"("pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.8}}],)");
    } else {
      put_materials(out, texturing_, is_draco() ? 1 : streams_.size(), extensions);
    }
    add_compression(extensions);
    put_extensions(out, extensions);
    put_accessors(out);
    put_views(out);
    while (out.size() % 4 != 0)
      out.text(" ");
    return out.take();
  }

  void add_compression(GlbExtensions& extensions) const {
    const auto add = [&](std::string_view name) {
      extensions.used.push_back(name), extensions.required.push_back(name);
    };
    if (is_draco()) add("KHR_draco_mesh_compression");
    if (!is_meshopt()) return;
    add("EXT_meshopt_compression");
    if (scale_ || !normals_.empty()) add("KHR_mesh_quantization");
  }

  std::string level_part() const {
    return options_.about.level ? ", level " + std::to_string(*options_.about.level) : "";
  }

  std::size_t attribute_count() const { return streams_.size() - 1; }

  void put_primitive(FileWriter& out, std::size_t i) const {
    const auto put_attributes = [&] {
      out.text(R"("attributes":{)");
      for (std::size_t a = 0; a < attribute_count(); ++a) {
        out.text(a == 0 ? "" : ","), out.quoted(streams_[a].semantic);
        out.text(":"), out.number(a);
      }
      out.text("}");
    };
    out.text("{"), put_attributes();
    out.text(R"(,"indices":)"), out.number(attribute_count() + i);
    out.text(R"(,"material":)"), out.number(primitives_[i].material);
    if (is_draco()) {
      out.text(R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)");
      put_attributes(), out.text("}}");
    }
    out.text("}");
  }

  // Writes an accessor without its closing brace.
  void put_accessor(FileWriter& out, std::size_t i, std::size_t offset, std::size_t count) const {
    const GlbStream& stream = streams_[i];
    out.text("{");
    if (!is_draco()) out.text(R"("bufferView":)"), out.number(i), out.text(",");
    if (offset > 0) out.text(R"("byteOffset":)"), out.number(offset), out.text(",");
    out.text(R"("componentType":)"), out.number(static_cast<unsigned>(stream.component));
    if (stream.is_normalised) out.text(R"(,"normalized":true)");
    out.text(R"(,"type":")"), out.text(element_type_of(stream));
    out.text(R"(","count":)"), out.number(count);
  }

  void put_accessors(FileWriter& out) const {
    out.text(R"("accessors":[)");
    for (std::size_t a = 0; a < attribute_count(); ++a) {
      put_accessor(out, a, 0, streams_[a].count);
      if (const auto& bounds = streams_[a].bounds) {
        out.text(R"(,"min":)"), put_floats(out, bounds->low);
        out.text(R"(,"max":)"), put_floats(out, bounds->high);
      }
      out.text("},");
    }
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
      const auto& [material, first, count] = primitives_[i];
      out.text(i == 0 ? "" : ",");
      put_accessor(out, attribute_count(), first * 3 * streams_.back().stride, count * 3);
      out.text("}");
    }
    out.text("],");
  }

  // Writes the members of a buffer view whose block is compressed. `at` is the byte offset of the
  // block. `decompressed_at` is the byte offset of the decompressed elements in the second buffer.
  // The file stores no data for that buffer.
  void put_compressed_view(FileWriter& out, const GlbStream& stream, std::size_t at,
                           std::size_t decompressed_at) const {
    out.text(R"("buffer":1,"byteOffset":)"), out.number(decompressed_at);
    out.text(R"(,"byteLength":)"), out.number(stream.count * stream.stride);
    out.text(R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)");
    out.number(at), out.text(R"(,"byteLength":)"), out.number(stream.bytes.size());
    out.text(R"(,"byteStride":)"), out.number(stream.stride);
    out.text(R"(,"count":)"), out.number(stream.count);
    out.text(R"(,"mode":)"), out.quoted(stream.mode);
    if (!stream.filter.empty()) out.text(R"(,"filter":)"), out.quoted(stream.filter);
    out.text("}}");
  }

  void put_views(FileWriter& out) const {
    out.text(R"("bufferViews":[)");
    const auto all = blocks();
    std::size_t at = 0, decompressed = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool is_stream = !is_draco() && i < streams_.size();
      out.text(i == 0 ? "{" : ",{");
      if (is_stream && is_meshopt()) {
        put_compressed_view(out, streams_[i], at, decompressed);
        decompressed += padded(streams_[i].count * streams_[i].stride);
      } else {
        out.text(R"("buffer":0,"byteOffset":)"), out.number(at);
        out.text(R"(,"byteLength":)"), out.number(all[i]->size());
      }
      if (is_stream) put_layout(out, i);
      out.text("}");
      at += padded(all[i]->size());
    }
    out.text(R"(],"buffers":[{"byteLength":)"), out.number(at), out.text("}");
    if (decompressed > 0) {
      out.text(R"(,{"byteLength":)"), out.number(decompressed);
      out.text(R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})");
    }
    out.text("]}");
  }

  void put_layout(FileWriter& out, std::size_t i) const {
    constexpr std::string_view kVertices = "34962", kIndices = "34963";
    const bool is_attribute = i < attribute_count();
    if (is_attribute) out.text(R"(,"byteStride":)"), out.number(streams_[i].stride);
    out.text(R"(,"target":)"), out.text(is_attribute ? kVertices : kIndices);
  }

  const TriangleMesh& mesh_;
  const Texturing& texturing_;
  std::span<const Vec3> normals_;  // one per vertex of the mesh, or empty
  const ExportOptions& options_;
  Vec3 place_;                   // the point of the scene to which stored positions are relative
  std::optional<double> scale_;  // scale of the node, if positions are stored as grid coordinates
  SeamVertices vertices_;  // the vertices and faces of the file; the faces are sorted by material
  std::vector<Primitive> primitives_;
  std::vector<GlbStream> streams_;  // the attributes, then the indices
  FileBytes draco_;                 // the compressed primitive
};

}  // namespace

Expected<FileBytes> write_glb(const TriangleMesh& mesh, const Texturing& texturing,
                              std::span<const Vec3> normals, const ExportOptions& options) {
  return GlbFile(mesh, texturing, normals, options).write();
}

}  // namespace vitrine::inline codec
