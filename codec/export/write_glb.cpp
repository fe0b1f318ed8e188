// SPDX-License-Identifier: Apache-2.0
// Writes binary glTF 2.0 [glTF]: one mesh with a primitive for each material in use. Colours are
// stored in linear light, from which every sRGB byte can be restored exactly. If the mesh is far
// from the origin, or compression rounds its positions, the positions are stored relative to the
// node's translation. The translation is decimal text, so it has more digits than a float. A
// textured mesh has texture coordinates instead of colours, and its pictures are in the file. All
// vertices into which a seam splits a vertex have the same normal.
//
// With coarser levels, the file has one node and one mesh for each level (MSFT_lod of [glTF]). The
// data of the coarsest level and the pictures come first in the file, so that a program that loads
// the file in parts can show them early.
#include <algorithm>
#include <string>

#include "codec/export/file_writer.h"
#include "codec/export/glb_description.h"
#include "codec/export/glb_material.h"
#include "codec/export/glb_mesh.h"
#include "codec/export/screen_coverage.h"
#include "codec/export/writers.h"
#include "codec/mesh/vertex_normals.h"

namespace vitrine::inline codec {
namespace {

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

// The content of a buffer view.
struct Block {
  const FileBytes* bytes = nullptr;
  const GlbStream* stream = nullptr;  // null for pictures and for primitives compressed by Draco
  bool is_attribute = false;
};

// The indices of a mesh's first buffer view and of its first accessor.
struct FirstOfMesh {
  std::size_t view = 0, accessor = 0;
};

class GlbFile {
 public:
  // `meshes` are the levels of detail, from fine to coarse.
  GlbFile(std::vector<GlbMesh> meshes, const Texturing& texturing, const ExportOptions& options,
          const Bounds& box)
      : meshes_(std::move(meshes)),
        texturing_(texturing),
        options_(options),
        coverages_(screen_coverages(box, options.coarser)),
        first_(meshes_.size()) {
    for (std::size_t m = meshes_.size(); m-- > 0;) {
      add_blocks(m);
      if (m + 1 == meshes_.size()) add_pictures();
    }
    std::size_t accessors = 0;
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      first_[m].accessor = accessors;
      accessors += meshes_[m].attribute_count() + meshes_[m].primitives.size();
    }
  }

  FileBytes write() const {
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
    for (const Block& block : blocks_) {
      out.text({reinterpret_cast<const char*>(block.bytes->data()), block.bytes->size()});
      out.text({"\0\0\0", padded(block.bytes->size()) - block.bytes->size()});
    }
    return out.take();
  }

 private:
  bool is_draco() const { return options_.compression == Compression::kDraco; }
  bool is_meshopt() const { return options_.compression == Compression::kMeshopt; }

  void add_blocks(std::size_t m) {
    const GlbMesh& mesh = meshes_[m];
    first_[m].view = blocks_.size();
    if (is_draco()) {
      blocks_.push_back({.bytes = &mesh.draco});
      return;
    }
    for (const GlbStream& stream : mesh.streams)
      blocks_.push_back({.bytes = &stream.bytes,
                         .stream = &stream,
                         .is_attribute = &stream != &mesh.streams.back()});
  }

  void add_pictures() {
    first_picture_ = blocks_.size();
    for (const EncodedPicture& picture : texturing_.pictures)
      blocks_.push_back({.bytes = &picture.bytes});
  }

  std::size_t binary_bytes() const {
    std::size_t bytes = 0;
    for (const Block& block : blocks_)
      bytes += padded(block.bytes->size());
    return bytes;
  }

  FileBytes json() const {
    FileWriter out(8192);
    GlbExtensions extensions;
    out.text("{"), put_asset(out, options_, extensions);
    out.text(R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[)");
    for (std::size_t m = 0; m < meshes_.size(); ++m)
      out.text(m == 0 ? "" : ","), put_node(out, m);
    out.text(R"(],"meshes":[)");
    for (std::size_t m = 0; m < meshes_.size(); ++m)
      out.text(m == 0 ? "" : ","), put_mesh(out, m);
    out.text("],");
    if (texturing_.empty()) {
      out.text(R"("materials":[{"doubleSided":true,)"
               R"("pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.8}}],)");
    } else {
      put_materials(out, texturing_, first_picture_, extensions);
    }
    add_extensions(extensions);
    put_extensions(out, extensions);
    put_accessors(out);
    put_views(out);
    while (out.size() % 4 != 0)
      out.text(" ");
    return out.take();
  }

  void add_extensions(GlbExtensions& extensions) const {
    const auto add = [&](std::string_view name) {
      extensions.used.push_back(name), extensions.required.push_back(name);
    };
    if (meshes_.size() > 1) extensions.used.emplace_back("MSFT_lod");
    if (is_draco()) add("KHR_draco_mesh_compression");
    if (!is_meshopt()) return;
    add("EXT_meshopt_compression");
    if (std::ranges::any_of(meshes_, &GlbMesh::is_quantised)) add("KHR_mesh_quantization");
  }

  // Returns the suffix of a name that states the level of mesh `m`.
  std::string level_part(std::size_t m) const {
    const auto level = m == 0 ? options_.about.level : options_.coarser[m - 1].level;
    return level ? ", level " + std::to_string(*level) : "";
  }

  void put_node(FileWriter& out, std::size_t m) const {
    const Vec3& place = meshes_[m].place;
    const std::optional<double>& scale = meshes_[m].scale;
    out.text(R"({"mesh":)"), out.number(m);
    put_name(out, options_.about, m == 0 ? "" : level_part(m));
    if (place != Vec3{}) out.text(R"(,"translation":)"), put_vector(out, place);
    if (scale) out.text(R"(,"scale":)"), put_vector(out, {*scale, *scale, *scale});
    if (m == 0 && meshes_.size() > 1) put_levels(out);
    out.text("}");
  }

  // Writes the members of the finest level's node that list the coarser levels and the screen
  // coverages of all levels.
  void put_levels(FileWriter& out) const {
    out.text(R"(,"extensions":{"MSFT_lod":{"ids":[)");
    for (std::size_t m = 1; m < meshes_.size(); ++m)
      out.text(m == 1 ? "" : ","), out.number(m);
    out.text(R"(]}},"extras":{"MSFT_screencoverage":[)");
    for (std::size_t m = 0; m < coverages_.size(); ++m)
      out.text(m == 0 ? "" : ","), out.number(static_cast<float>(coverages_[m]));
    out.text("]}");
  }

  void put_mesh(FileWriter& out, std::size_t m) const {
    out.text(R"({"primitives":[)");
    for (std::size_t i = 0; i < meshes_[m].primitives.size(); ++i)
      out.text(i == 0 ? "" : ","), put_primitive(out, m, i);
    out.text("]"), put_name(out, options_.about, level_part(m)), out.text("}");
  }

  void put_primitive(FileWriter& out, std::size_t m, std::size_t i) const {
    const GlbMesh& mesh = meshes_[m];
    const auto put_attributes = [&](std::size_t first) {
      out.text(R"("attributes":{)");
      for (std::size_t a = 0; a < mesh.attribute_count(); ++a) {
        out.text(a == 0 ? "" : ","), out.quoted(mesh.streams[a].semantic);
        out.text(":"), out.number(first + a);
      }
      out.text("}");
    };
    out.text("{"), put_attributes(first_[m].accessor);
    out.text(R"(,"indices":)"), out.number(first_[m].accessor + mesh.attribute_count() + i);
    out.text(R"(,"material":)"), out.number(mesh.primitives[i].material);
    if (is_draco()) {
      out.text(R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)");
      out.number(first_[m].view), out.text(","), put_attributes(0), out.text("}}");
    }
    out.text("}");
  }

  // The part of a stream that an accessor reads.
  struct Elements {
    std::size_t offset = 0, count = 0;  // offset in bytes, number of elements
  };

  // Writes an accessor of stream `i` of mesh `m`, without its closing brace.
  void put_accessor(FileWriter& out, std::size_t m, std::size_t i, const Elements& part) const {
    const GlbStream& stream = meshes_[m].streams[i];
    out.text("{");
    if (!is_draco()) out.text(R"("bufferView":)"), out.number(first_[m].view + i), out.text(",");
    if (part.offset > 0) out.text(R"("byteOffset":)"), out.number(part.offset), out.text(",");
    out.text(R"("componentType":)"), out.number(static_cast<unsigned>(stream.component));
    if (stream.is_normalised) out.text(R"(,"normalized":true)");
    out.text(R"(,"type":")"), out.text(element_type_of(stream));
    out.text(R"(","count":)"), out.number(part.count);
  }

  void put_accessors(FileWriter& out) const {
    out.text(R"("accessors":[)");
    for (std::size_t m = 0; m < meshes_.size(); ++m)
      out.text(m == 0 ? "" : ","), put_accessors_of(out, m);
    out.text("],");
  }

  void put_accessors_of(FileWriter& out, std::size_t m) const {
    const GlbMesh& mesh = meshes_[m];
    for (std::size_t a = 0; a < mesh.attribute_count(); ++a) {
      put_accessor(out, m, a, {.count = mesh.streams[a].count});
      if (const auto& bounds = mesh.streams[a].bounds) {
        out.text(R"(,"min":)"), put_floats(out, bounds->low);
        out.text(R"(,"max":)"), put_floats(out, bounds->high);
      }
      out.text("},");
    }
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const auto& [material, first, count] = mesh.primitives[i];
      out.text(i == 0 ? "" : ",");
      put_accessor(out, m, mesh.attribute_count(),
                   {.offset = first * 3 * mesh.streams.back().stride, .count = count * 3});
      out.text("}");
    }
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
    std::size_t at = 0, decompressed = 0;
    for (const Block& block : blocks_) {
      out.text(&block == blocks_.data() ? "{" : ",{");
      if (block.stream != nullptr && is_meshopt()) {
        put_compressed_view(out, *block.stream, at, decompressed);
        decompressed += padded(block.stream->count * block.stream->stride);
      } else {
        out.text(R"("buffer":0,"byteOffset":)"), out.number(at);
        out.text(R"(,"byteLength":)"), out.number(block.bytes->size());
      }
      if (block.stream != nullptr) put_layout(out, block);
      out.text("}");
      at += padded(block.bytes->size());
    }
    out.text(R"(],"buffers":[{"byteLength":)"), out.number(at), out.text("}");
    if (decompressed > 0) {
      out.text(R"(,{"byteLength":)"), out.number(decompressed);
      out.text(R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})");
    }
    out.text("]}");
  }

  void put_layout(FileWriter& out, const Block& block) const {
    constexpr std::string_view kVertices = "34962", kIndices = "34963";
    if (block.is_attribute) out.text(R"(,"byteStride":)"), out.number(block.stream->stride);
    out.text(R"(,"target":)"), out.text(block.is_attribute ? kVertices : kIndices);
  }

  const std::vector<GlbMesh> meshes_;  // levels of detail, from fine to coarse
  const Texturing& texturing_;         // materials and pictures of all meshes
  const ExportOptions& options_;
  const std::vector<double> coverages_;  // the values of MSFT_screencoverage
  std::vector<Block> blocks_;            // in the order of the file
  std::vector<FirstOfMesh> first_;       // one entry per mesh
  std::size_t first_picture_ = 0;        // index of the first picture's buffer view
};

// Returns a coarser level in the form in which the file stores it. Its faces have the material of
// the finest level.
Expected<GlbMesh> coarser_mesh(const CoarserLevel& level, const Texturing& finest, bool is_smooth,
                               Compression compression) {
  Texturing texturing;
  if (!finest.empty()) {
    texturing.materials = finest.materials;
    texturing.face_materials.assign(level.mesh.faces.size(), 0);
    texturing.coordinates[0] = level.coordinates;
  }
  const std::vector<Vec3> normals = is_smooth ? unit_normals(level.mesh) : std::vector<Vec3>();
  return glb_mesh({.mesh = level.mesh,
                   .texturing = texturing,
                   .normals = normals,
                   .compression = compression,
                   .grid = level.grid});
}

}  // namespace

Expected<FileBytes> write_glb(const TriangleMesh& mesh, const Texturing& texturing,
                              std::span<const Vec3> normals, const ExportOptions& options) {
  std::vector<GlbMesh> meshes;
  auto finest = glb_mesh({.mesh = mesh,
                          .texturing = texturing,
                          .normals = normals,
                          .compression = options.compression,
                          .grid = options.grid});
  if (!finest) return tl::unexpected(finest.error());
  meshes.push_back(std::move(*finest));
  for (const CoarserLevel& level : options.coarser) {
    auto coarser = coarser_mesh(level, texturing, !normals.empty(), options.compression);
    if (!coarser) return tl::unexpected(coarser.error());
    meshes.push_back(std::move(*coarser));
  }
  return GlbFile(std::move(meshes), texturing, options, bounds_of(mesh.positions)).write();
}

}  // namespace vitrine::inline codec
